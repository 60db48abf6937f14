// SPDX-License-Identifier: MIT
// Makes the calls of a run fail in turn.
#pragma once

#include "faults/runs.h"

#include <stdbool.h>

// What to do with each run, and how often.
typedef struct TortureOptions {
    const char *bin;  // folder of the programs; those with faults in bin/faults
    const char *work; // folder for all files, absolute
    bool whole;       // the long form
    unsigned seed;
    int jobs;     // at once
    int per_site; // long form: at most so many calls of a call site; 0: all
    int kills;    // of each kind
    double limit_s;
} TortureOptions;

typedef struct FaultTally {
    int calls, sites; // of the undisturbed run
    int injected;
    int failed, managed; // as they should: with an error, or done all the same
    int missed;          // never reached: threads took turns differently
    int wrong;           // faults found
} FaultTally;

// Prints a line for each fault that it finds.
void faults_run(const Run *run, const TortureOptions *options, FaultTally *tally);
