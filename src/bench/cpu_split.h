// SPDX-License-Identifier: MIT
// What the processor could do, as a yardstick for the driver that runs on it: the memory's
// bandwidth, and a step of `split` in plain C: the same rule
// as glsl/sim/split.comp (its default form, a head that stays, no wind), a strand after another or
// several side by side for the compiler to vectorise, on any number of threads.
#pragma once

#include "base/error.h"
#include "bench/table.h"
#include "strands/strands.h"

typedef enum CpuSplitForm {
    CPU_SPLIT_SCALAR, // a strand after another
    CPU_SPLIT_LANES,  // CPU_SPLIT_WIDTH strands side by side
} CpuSplitForm;

enum { CPU_SPLIT_WIDTH = 16 };

// Strands of equal vertex count. Floats of a tile of CPU_SPLIT_WIDTH strands: for each of its
// links x[WIDTH], y[WIDTH], z[WIDTH] of the unit direction and length[WIDTH]; for its ends root,
// tip, velocity (three such rows each) and the strands' lengths.
typedef struct CpuSplit {
    uint32_t strand_count, link_count, tile_count;
    float *links, *ends;
    float gravity[3], dt, decay, gain; // of the next step, see cpu_split_time
} CpuSplit;

// At rest where the strands are. RESULT_USAGE if their vertex counts differ. Destroying a zeroed
// struct is legal.
Result cpu_split_create(CpuSplit *split, const Strands *strands, Error *error);
void cpu_split_destroy(CpuSplit *split);

// Sets the next steps' length, drag (1/s) and whether they are the first from rest, for dt/2.
void cpu_split_time(CpuSplit *split, double dt, double drag, bool first);

// A step of the tiles from `first` to before `last`.
void cpu_split_step(CpuSplit *split, CpuSplitForm form, uint32_t first, uint32_t last);

// Positions of all strands from root to tip, drawn without style.
void cpu_split_read(const CpuSplit *split, float (*positions)[3]);

// What the lanes were compiled for: "AVX2" or "baseline".
const char *cpu_split_lanes(void);

// The strands' length, m.
double cpu_split_length(const CpuSplit *split);

// Times `steps` steps after `warm_up` on up to PARALLEL_MOST threads. RESULT_FAILED when memory is
// short.
Result cpu_split_time_steps(Times *times, CpuSplit *split, CpuSplitForm form, int threads,
                            int steps, int warm_up, Error *error);

// Times a[i] = b[i] + 3 c[i] over three arrays of 64 MiB, *bytes together, on all processors,
// *threads of them. RESULT_FAILED when memory is short.
Result cpu_split_time_memory(Times *times, double *bytes, int *threads, Error *error);
