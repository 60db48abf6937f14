// SPDX-License-Identifier: MIT
// Kills runs at random moments and resumes them.
#pragma once

#include "faults/faults.h"

typedef struct KillTally {
    int kills, wrong;
    int by[3]; // SIGKILL, SIGTERM, SIGINT
    int late;  // of the above: the run had finished before
} KillTally;

// Half of the kills are by SIGKILL, a quarter each by SIGTERM and SIGINT. After a kill, each file
// except for a cache is complete or absent; --resume (or, for a video, the same command again)
// produces the bytes of an uninterrupted run and removes leftovers. Prints a line for each
// violation.
void kills_run(const Run *run, const TortureOptions *options, KillTally *tally);
