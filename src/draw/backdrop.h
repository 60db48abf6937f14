// SPDX-License-Identifier: MIT
// The environment as the background of an image: its light in each pixel.
#pragma once

#include "base/error.h"
#include "draw/renderer_options.h"

#include "glsl/draw/draw.h"

// A zeroed struct is empty.
typedef struct Backdrop {
    float (*light)[4]; // [height][width], owned: linear RGB with exposure; 1
    int width, height; // px
    size_t room;
    DrawParams drawn; // the parameters for which it was made
    uint64_t version; // incremented when it changes
} Backdrop;

// Finds the light of `ambient`, which must be an environment that keeps its image, in each pixel of
// the image or window that `draw` shows. RESULT_FAILED if memory is short.
Result backdrop_find(Backdrop *backdrop, const Ambient *ambient, const RendererOptions *options,
                     const DrawParams *draw, Error *error);
void backdrop_destroy(Backdrop *backdrop);
