// SPDX-License-Identifier: MIT
// A place where one run after the other takes place: work/N/run, with work/N/tmp for its temporary
// files.
#pragma once

#include "faults/child.h"
#include "faults/folder.h"
#include "faults/runs.h"

#include <stdbool.h>

typedef struct Place {
    char root[4096], run[4200], tmp[4200], log[4200];
} Place;

// `work`: absolute path of the harness's folder.
void place_create(Place *place, const char *work, int number);

// What a run is besides its arguments.
typedef struct Attempt {
    const char *bin;   // folder of the programs
    const char *fault; // TRACTRIX_FAULT, NULL: the calls are only listed, in place->log
    bool resumes;      // with --resume
    double limit_s;
    double kill_after_s; // negative: never
    int kill_signal;
} Attempt;

// Empties the folders, unless it resumes, and runs.
void place_run(const Place *place, const Run *run, const Attempt *attempt, ChildEnd *end);

// Waits until no process works in the run's folder any more, 10 s at most.
void place_wait_left(const Place *place);

typedef enum FilesState {
    FILES_KILLED,  // some are there, and temporaries
    FILES_PARTIAL, // some are there
    FILES_WHOLE,   // all are there
} FilesState;

// What is wrong with the files after a run: NULL or a text in `words`. A file is as in `reference`
// or not there at all; of a run that grows and is not whole, the cache and its state may be
// anything. Nothing else may lie there.
const char *place_judge_files(const Place *place, const Run *run, const Folder *reference,
                              FilesState state, char words[300]);

// What is wrong with how a run has ended: NULL or a text in `words`. `reason`: what the line must
// say, "": anything. Sets *whole if the run is done all the same.
const char *place_judge_end(const Run *run, const ChildEnd *end, const char *reason, bool *whole,
                            char words[300]);
