// SPDX-License-Identifier: MIT
// Makes the calls of a run fail one after the other.
#pragma once

#include "faults/runs.h"

#include <stdbool.h>

// How runs are tested, and how often.
typedef struct TortureOptions {
    const char *bin;  // folder of the programs; bin/faults has those with fault injection
    const char *work; // folder for all files, absolute
    bool whole;       // the long form
    unsigned seed;
    int jobs;     // in parallel
    int per_site; // long form: calls per call site at most; 0: all
    int kills;    // of each kind
    double limit_s;
} TortureOptions;

typedef struct FaultTally {
    int calls, sites; // of the run without faults
    int injected;
    int failed, managed; // as expected: ended with an error, or succeeded in spite of the fault
    int missed;          // call never reached, because threads ran in another order
    int wrong;           // defects found
} FaultTally;

// Prints a line for each defect.
void faults_run(const Run *run, const TortureOptions *options, FaultTally *tally);
