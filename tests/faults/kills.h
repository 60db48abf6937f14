// SPDX-License-Identifier: MIT
// Kills runs at random moments and lets them be resumed.
#pragma once

#include "faults/faults.h"

typedef struct KillTally {
    int kills, wrong;
    int by[3]; // SIGKILL, SIGTERM, SIGINT
    int late;  // of them: the run had ended before
} KillTally;

// Of every four kills two are by SIGKILL, one by SIGTERM and one by SIGINT. After a kill each file
// is whole or absent, but for a cache; --resume (of a video: the same command again) gives the
// bytes of an undisturbed run and removes what was left. Prints a line for each that does not.
void kills_run(const Run *run, const TortureOptions *options, KillTally *tally);
