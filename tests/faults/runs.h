// SPDX-License-Identifier: MIT
// The small runs that faults and kills are put into.
#pragma once

#include <stdbool.h>

enum { RUN_WORDS = 48 };

typedef struct Run {
    const char *program;   // tractrix-PROGRAM
    const char *name;      // what it writes
    const char *arguments; // with blanks between; runs in an empty folder, inputs are in ../../in/,
                           // the project is ../../root/
    const char
        *measured;    // files with times in them, of the same form each time, not the same bytes
    bool grows;       // its cache may be cut off, --resume completes it
    bool one_piece;   // the same command starts anew: there is no --resume
    int short_faults; // of the short form: this many call sites, spread evenly over them all
    int status;       // of the undisturbed run
} Run;

// Both end with a row without program.
extern const Run RUN_PREPARED[]; // make the inputs, in in/
extern const Run RUNS[];

// Runs that are killed: PNG frames, video, cache, export.
extern const Run RUN_KILLED[];

// The words of run->arguments behind the program's name and before NULL; `text` keeps them.
void run_words(const Run *run, char text[1000], char *words[RUN_WORDS]);
