// SPDX-License-Identifier: MIT
// Writes `.npz` with all frames of an animation; single frames are written through the table of
// formats.
#pragma once

#include "base/outfile.h"
#include "strands/strands.h"

typedef struct NpzFrames {
    uint32_t count;             // 0 for a single frame
    const float (*position)[3]; // [count * vertex_count]
    double fps;
    int first; // number of the first frame
} NpzFrames;

// The strands must hold the positions of the first frame, `frames` those of all. RESULT_FAILED when
// memory is short or the file exceeds 4 GiB.
Result npz_write_frames(OutFile *file, const Strands *strands, const NpzFrames *frames,
                        Error *error);
