// SPDX-License-Identifier: MIT
// The main loop: iterates over a scene's frames, draws the requested ones, and passes them to the
// output.
#pragma once

#include "run/export.h"
#include "run/frame_source.h"
#include "run/images_output.h"
#include "run/stats.h"

typedef struct Sequence {
    const Scene *scene;
    FrameSource *source; // moves its simulation
    Images *images;      // empty: nothing is drawn
    Output *output;      // of the images; NULL: none
    Exporter *exporter;  // NULL: no hair files
    const Fingerprint *fingerprint;
    const bool *done; // [frames] that need not be drawn again; NULL: none
    GpuTimer *timer;
    Stats *stats; // may be turned off
    int frames_drawn;
    int frames_repeated; // equal to the previous frame: written again but not drawn
} Sequence;

// The last frame that is needed, and whether a frame is drawn (--first, --last, --every).
int sequence_last_frame(const RunParams *run);
bool sequence_draws_frame(const RunParams *run, int frame);

// The number of frames to draw.
int sequence_count_drawn(const RunParams *run);

// Processes all frames. RESULT_INTERRUPTED between two frames after SIGINT or SIGTERM.
Result sequence_run(Sequence *sequence, Error *error);
