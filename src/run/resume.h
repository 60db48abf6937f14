// SPDX-License-Identifier: MIT
// What an interrupted run has left: which of its files are there and whole (--resume).
#pragma once

#include "base/params.h"
#include "base/target.h"

typedef struct Resume {
    bool *done; // [frames]: all files of the frame are whole; NULL: none is
    int count;  // how many
} Resume;

// Looks at each frame first .. last by steps of `every`. A picture is whole if it is a PNG file of
// the run's size and channels whose chunks are complete with right checksums; a hair file if it is
// there, since those appear complete or not at all. RESULT_USAGE for a video, or a USD file of all
// frames, without --cache: it cannot be continued, only the simulation behind it can. RESULT_FAILED
// when memory is short. A zeroed struct may be destroyed.
Result resume_find(Resume *resume, const RunParams *run, int last, Error *error);
void resume_destroy(Resume *resume);
