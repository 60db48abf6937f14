// SPDX-License-Identifier: MIT
// What stands behind and among the hair, read back from the driver for the block rasteriser.
#pragma once

#include "draw/block_pixels.h"
#include "draw/render_target.h"

// A zeroed struct is empty.
typedef struct RenderBehind {
    BlockBase base;
    uint16_t (*light)[4]; // [room], owned
    float *depth;         // [room], owned
    size_t room;
    uint64_t version; // of what was read; 0: nothing was
} RenderBehind;

// Reads the target's base and depth within `box` (samples: x, y lowest, highest), unless that was
// read when they were of the same version (from 1 on). Waits for them. RESULT_FAILED if memory is
// short.
Result render_behind_read(RenderBehind *behind, const RenderTarget *target, const int box[4],
                          uint64_t version, Error *error);
void render_behind_destroy(RenderBehind *behind);
