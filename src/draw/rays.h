// SPDX-License-Identifier: MIT
// The vectors from the eye through the pixels of an image (ray.glsl).
#pragma once

#include "glsl/draw/draw.h"

// The vector through the point (x, y) of the image (samples) to the plane one metre in front of the
// eye, in the world's axes: x across + y down + from.
typedef struct Rays {
    float across[3], down[3], from[3];
} Rays;

Rays rays_find(const DrawParams *draw);
