// SPDX-License-Identifier: MIT
// Writes `.npz` with all frames of an animation; stills go through the table of formats.
#pragma once

#include "base/outfile.h"
#include "strands/strands.h"

typedef struct NpzFrames {
    uint32_t count;             // 0: a still
    const float (*position)[3]; // [count * vertex_count]
    double fps;
    int first; // number of the first frame
} NpzFrames;

// Positions are those of the strands, which are the first frame's, and `frames` of all.
// RESULT_FAILED when memory is short or the file is beyond 4 GiB.
Result npz_write_frames(OutFile *file, const Strands *strands, const NpzFrames *frames,
                        Error *error);
