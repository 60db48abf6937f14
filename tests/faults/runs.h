// SPDX-License-Identifier: MIT
// The small runs that are tested with faults and kills.
#pragma once

#include <stdbool.h>

enum { RUN_WORDS = 48 };

typedef struct Run {
    const char *program;   // tractrix-PROGRAM
    const char *name;      // what it writes
    const char *arguments; // separated by blanks; runs in an empty folder, with inputs in ../../in/
                           // and the project in ../../root/
    const char *measured;  // files that contain times: only their form is compared
    bool grows;            // its cache may be truncated, and --resume completes it
    bool one_piece;        // has no --resume: the same command starts again
    int short_faults;      // short form: number of call sites, spread evenly over all
    int status;            // of the run without faults
} Run;

// Both end with a row whose program is NULL.
extern const Run RUN_PREPARED[]; // create the inputs in in/
extern const Run RUNS[];

// Runs that are killed: PNG frames, video, cache, export.
extern const Run RUN_KILLED[];

// Splits run->arguments into words behind the program's name, NULL-terminated; `text` stores them.
void run_words(const Run *run, char text[1000], char *words[RUN_WORDS]);
