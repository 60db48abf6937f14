// SPDX-License-Identifier: MIT
// What an interrupted run has left, so that --resume draws only what is missing.
#pragma once

#include "run/fingerprint.h"

// A zeroed struct may be destroyed.
typedef struct FramesDone {
    bool *done; // [frames]: all files of the frame are complete; NULL: none
    int count;  // how many
    int stale;  // files that are there but not those of this run
    Error why;  // which is the first of them, and why
} FramesDone;

// Refuses a video, or a USD file of all frames, without --cache: only its simulation can be
// continued. RESULT_USAGE, RESULT_FAILED when memory is short.
Result resume_check(const RunParams *run, Error *error);

// Looks at each frame that the run draws, up to `last`. An image is done if all of its file can be
// read, it has the run's size, depth and channels, and its texts say this program, this driver and
// this fingerprint; of a .pfm file its record says so (record.h). A hair file is done if its record
// says so. RESULT_FAILED when memory is short.
Result resume_find(FramesDone *done, const RunParams *run, int last, const Fingerprint *fingerprint,
                   Error *error);
void resume_destroy(FramesDone *done);
