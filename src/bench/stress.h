// SPDX-License-Identifier: MIT
// `tractrix-bench stress`: random circumstances for every solver, within what is documented, until
// something breaks; what breaks is made as small as it goes and printed with the command that
// repeats it.
#pragma once

#include "bench/table.h"
#include "gpu/gpu.h"

#include <stdbool.h>
#include <stdio.h>

typedef struct StressOptions {
    const char *algo, *variant; // NULL: all
    const char *text;           // --case: this one instead of random ones; NULL: none
    int cases;                  // of each solver's form, 1 .. 10^6
    int steps;                  // of each case, 1 .. 10^6
    int seed;
    double allowed; // share of each bound that a case may use, above 0 to 1
    bool shrinks;   // failures are made smaller before they are printed
} StressOptions;

// The defaults.
StressOptions stress_options_default(void);

// Prints a line for each solver's form, those of failures between, and a sum. A case is a strand
// under a set of circumstances; STRESS_STRANDS strands share a set. The files get a row for each
// form, for each case that failed, and for what these were made smaller to ("form", "failed",
// "smallest"). RESULT_FAILED if a case failed, RESULT_INTERRUPTED after what was done until then
// has been printed and written.
enum { STRESS_STRANDS = 32 };
Result stress_search(const Gpu *gpu, const StressOptions *options, const TableOutput *output,
                     FILE *stream, Error *error);
