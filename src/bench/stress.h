// SPDX-License-Identifier: MIT
// `tractrix-bench stress`: simulates random circumstances within the documented ranges with every
// solver until a bound is broken. Simplifies each failure as far as possible and prints it with the
// command that repeats it.
#pragma once

#include "bench/table.h"
#include "gpu/gpu.h"

#include <stdbool.h>
#include <stdio.h>

typedef struct StressOptions {
    const char *algo, *variant; // NULL: all
    const char *text;           // --case: replaces random cases; NULL: random cases
    int cases;                  // per solver variant, 1 .. 10^6
    int steps;                  // per case, 1 .. 10^6
    int seed;
    double allowed; // share of each bound that a case may use, > 0, at most 1
    bool shrinks;   // failures are simplified before they are printed
} StressOptions;

// The defaults.
StressOptions stress_options_default(void);

// Prints a line per solver variant, lines of failures between them, and a total. A case is a strand
// under a set of circumstances; STRESS_STRANDS strands share a set. The files get a row for each
// variant ("form"), for each failed case ("failed"), and for its simplified case ("smallest").
// RESULT_FAILED if a case failed; RESULT_INTERRUPTED after printing and writing what was done.
enum { STRESS_STRANDS = 32 };
Result stress_search(const Gpu *gpu, const StressOptions *options, const TableOutput *output,
                     FILE *stream, Error *error);
