// SPDX-License-Identifier: MIT
// The results that an interrupted run has left: --resume draws only what is missing.
#pragma once

#include "run/fingerprint.h"

// A zeroed struct may be destroyed.
typedef struct FramesDone {
    bool *done; // [frames]: all files of the frame are complete; NULL: no frame is done
    int count;  // number of such frames
    int stale;  // number of existing files that are not this run's
    Error why;  // the first of those, and the reason
} FramesDone;

// Refuses a video, or a USD file of all frames, without --cache, since only the simulation of such
// a run can be continued. RESULT_USAGE, RESULT_FAILED when memory is short.
Result resume_check(const RunParams *run, Error *error);

// Checks each frame that the run draws, up to `last`. An image is done if its file can be read
// completely, has the run's size, depth and channels, and its texts (for .pfm, its record:
// record.h) name this program, this driver and this fingerprint. A hair file is done if its record
// does. RESULT_FAILED when memory is short.
Result resume_find(FramesDone *done, const RunParams *run, int last, const Fingerprint *fingerprint,
                   Error *error);
void resume_destroy(FramesDone *done);
