// SPDX-License-Identifier: MIT
// Draws a case of path-traced light by our own path tracer (light_reference.h).
#pragma once

#include "bench/light_stage.h"

enum {
    TRACED_PATHS = 8,   // for each pixel and image of --frames
    TRACED_ORDERS = 64, // stands for all
};

// Draws the stage's hair at rest into an image (light_reference.h) of the stage's size. `orders`:
// the most fibres that light meets; `paths`: for each pixel. RESULT_USAGE for a scene with a mesh,
// or with fibres that differ, move or have other than Marschner's shading with scales that are not
// tilted.
Result light_traced_draw(LightStage *stage, Image *image, int orders, int paths, Error *error);
