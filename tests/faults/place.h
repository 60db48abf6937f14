// SPDX-License-Identifier: MIT
// A folder in which one run after the other is started: work/N/run, with work/N/tmp for its
// temporary files.
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

// What a run needs besides its arguments.
typedef struct Attempt {
    const char *bin;   // folder of the programs
    const char *fault; // TRACTRIX_FAULT, NULL: the calls are only listed, in place->log
    bool resumes;      // with --resume
    double limit_s;
    double kill_after_s; // negative: never
    int kill_signal;
} Attempt;

// Empties the folders, unless the run resumes, and runs.
void place_run(const Place *place, const Run *run, const Attempt *attempt, ChildEnd *end);

// Waits until no process uses the run's folder any more, for 10 s at most.
void place_wait_left(const Place *place);

typedef enum FilesState {
    FILES_KILLED,  // some files and temporary files may exist
    FILES_PARTIAL, // some files may exist
    FILES_WHOLE,   // all files must exist
} FilesState;

// Judges the files after a run: returns NULL, or the problem as text in `words`. Each file must
// equal that of `reference` or be absent. If the run grows a cache and is not complete, the cache
// and its state may contain anything. Other files must not exist.
const char *place_judge_files(const Place *place, const Run *run, const Folder *reference,
                              FilesState state, char words[300]);

// Judges the end of a run: returns NULL, or the problem as text in `words`. `reason`: what the
// error line must say, "": anything. Sets *whole if the run succeeded in spite of the fault.
const char *place_judge_end(const Run *run, const ChildEnd *end, const char *reason, bool *whole,
                            char words[300]);
