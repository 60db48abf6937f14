// SPDX-License-Identifier: MIT
// Where a light's shadow map lies: a window of square texels across the light, and a range along
// it.
#pragma once

#include "scene/scene.h"

#include <stdbool.h>

// A point's place before the light: (u, v) across and the depth along the way of the light. Three
// axes at right angles; u, v and depth are metres along them for a directional light. Before a lamp
// depth is metres from its plane, and u and v are metres for each metre of depth.
typedef struct LightView {
    double axis[3][3]; // unit: of u, of v, of depth
    double origin[3];  // m
    bool perspective;
} LightView;

// A lamp looks at `middle` (world, m).
LightView light_frame_view(const Light *light, const float middle[3]);

// Row k of the matrix by which (x, y, z, 1) becomes (u w, v w, depth, w).
void light_frame_row(const LightView *view, int k, double row[4]);

// place: u, v, depth. `x`: world, m. False if it does not lie before the light.
bool light_frame_place(const LightView *view, const double x[3], double place[3]);

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
