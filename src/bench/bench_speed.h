// SPDX-License-Identifier: MIT
// How long a solver's step and a drawn frame take: the command `tractrix-bench speed`, and what its
// parts (bench_scaling.h and its siblings) share.
#pragma once

#include "bench/bench_options.h"
#include "strands/strands.h"

// What is measured: hair and a solver.
typedef struct SpeedSubject {
    const char *name;       // of the hair, without folders
    const char *set, *file; // where it comes from; both NULL: made by the part itself
    const Strands *strands;
    Method method;
} SpeedSubject;

typedef struct SpeedResult {
    uint64_t bytes;       // of the buffers that a step and its pose use, each once a way
    double first_step_ms; // with shader compilation, unless the driver's cache has it
    Times step;  // what moves the hair one step further and writes the positions that are drawn
    Times solve; // its part without the positions
    Times draw;  // drawing and reading back; NaN without
    uint64_t fragments; // of the last picture
} SpeedResult;

// Measures with the wall clock, waiting for the GPU at the end of each sample: options->steps of
// 1/60 s from rest under gravity, after options->warm_up; pictures of options->size.
Result speed_measure(SpeedResult *result, const Gpu *gpu, const SpeedSubject *subject,
                     const BenchOptions *options, Error *error);

typedef struct SpeedRow {
    const char *part;
    char hair[64];
    const char *set, *file;
    Method method;
    long strands, vertices, particles; // vertices: of the first strand
    long threads;                      // of the driver or the program; 0: as many as it likes
    SpeedResult result;
    double thesis_ms, bound_ms; // what the thesis states for its GPU, what we state
    double exponent, spread;    // of a fit over a part's rows, its standard error
    double gigabytes_s;         // where the row is not a step
    double process_ms;          // wall time of a process of its own
    double off, off_bound;      // from the GPU's strands, RMS over the length; what is stated
    const char *remark;
} SpeedRow;

typedef struct Speed {
    const Gpu *gpu;
    const BenchOptions *options;
    Table table;
    Method methods[METHODS_MOST];
    int method_count;
    double bandwidth; // of the memory, GB/s; measured once
} Speed;

// The command: all parts, or those that --part lists; with --set or --tfx and no --part only
// "sets". RESULT_FAILED if a stated bound is broken, after all rows.
Result speed_run(const BenchOptions *options, const Gpu *gpu, Error *error);

// A row of which only what the subject says is known; the subject may be NULL.
SpeedRow speed_row(const char *part, const SpeedSubject *subject);

// Checks the bound, and adds the row with what follows from it and the command that repeats it.
void speed_add(Speed *speed, const SpeedRow *row);

// The hair that is asked for: --set, --tfx, or all of the thesis's sets and the files that are
// named. `use` is called with each set and method.
Result speed_for_each(Speed *speed,
                      Result (*use)(Speed *speed, const SpeedSubject *subject, Error *error),
                      Error *error);
