// SPDX-License-Identifier: MIT
// Where a light's shadow map lies: a window of square texels across the light, and a range along
// it.
#pragma once

#include "draw/light_view.h"

// Beyond these, u and v before a light do not count: a lamp sees no farther than 75 degrees off its
// axis, and what lies 1,000 km away is broken.
#define LIGHT_FRAME_FAR  1e6
#define LIGHT_FRAME_WIDE 3.7

typedef struct LightFrame {
    double rows[4][4]; // by which (x, y, z, 1) becomes (u w, v w, depth, w): u and v in texels of
                       // the map, depth 0..1
    double texel;      // m; before a lamp m at a depth of one metre
    double depth[2];   // m, that are 0 and 1
} LightFrame;

// Around `box` (lowest u, v, depth, then the highest, as LightView has them), with `margin` texels
// left free at the edges of `side`. The window changes in steps as the box does, so that shadows do
// not swim with every frame: its size in eighths of octaves, its middle by whole texels.
// Depths are linear: the box's and some more, also in steps.
LightFrame light_frame_steady(const LightView *view, const double box[6], int side, int margin);

// The same window with the depths that OpenGL draws: before a lamp linear on the screen.
LightFrame light_frame_drawn(const LightView *view, const double box[6], int side, int margin);
