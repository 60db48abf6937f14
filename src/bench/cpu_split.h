// SPDX-License-Identifier: MIT
// What the processor can do, for comparison with the OpenGL driver that runs on it: memory
// bandwidth, and a step of `split` in plain C. It uses the rule of glsl/sim/split.comp (default
// form, still head, no wind), strand by strand or several strands together for the compiler to
// vectorise, on any number of threads.
#pragma once

#include "base/error.h"
#include "bench/table.h"
#include "strands/strands.h"

typedef enum CpuSplitForm {
    CPU_SPLIT_SCALAR, // one strand after the other
    CPU_SPLIT_LANES,  // CPU_SPLIT_WIDTH strands together
} CpuSplitForm;

enum { CPU_SPLIT_WIDTH = 16 };

// Strands of equal vertex count in tiles of CPU_SPLIT_WIDTH strands. Floats of a tile in `links`:
// for each link x[WIDTH], y[WIDTH], z[WIDTH] of the unit direction, and length[WIDTH]. In `ends`:
// root, tip and velocity (three such rows each) and the strands' lengths.
typedef struct CpuSplit {
    uint32_t strand_count, link_count, tile_count;
    float *links, *ends;
    float gravity[3], dt, decay, gain; // for the next step, see cpu_split_time
} CpuSplit;

// Starts at rest at the strands' positions. RESULT_USAGE if vertex counts differ. A zeroed struct
// may be destroyed.
Result cpu_split_create(CpuSplit *split, const Strands *strands, Error *error);
void cpu_split_destroy(CpuSplit *split);

// Sets the duration and drag (1/s) of the next steps, and whether the next is the first from rest,
// where forces act for dt/2.
void cpu_split_time(CpuSplit *split, double dt, double drag, bool first);

// Steps the tiles first .. last - 1.
void cpu_split_step(CpuSplit *split, CpuSplitForm form, uint32_t first, uint32_t last);

// Positions of all strands from root to tip, drawn without style.
void cpu_split_read(const CpuSplit *split, float (*positions)[3]);

// The instruction set of the vectorised form: "AVX2" or "baseline".
const char *cpu_split_lanes(void);

// The strands' length, m.
double cpu_split_length(const CpuSplit *split);

// Times `steps` steps after `warm_up` on up to PARALLEL_MOST threads. RESULT_FAILED when memory is
// short.
Result cpu_split_time_steps(Times *times, CpuSplit *split, CpuSplitForm form, int threads,
                            int steps, int warm_up, Error *error);

// Times a[i] = b[i] + 3 c[i] over three arrays of 64 MiB on all processors; *bytes: their size
// together, *threads: number of threads. RESULT_FAILED when memory is short.
Result cpu_split_time_memory(Times *times, double *bytes, int *threads, Error *error);
