// SPDX-License-Identifier: MIT
// The place of a light's shadow map: a window of square texels across the light, and a range of
// depths along it.
#pragma once

#include "scene/scene.h"

#include <stdbool.h>

// Coordinates of a point as the light sees it: (u, v) across the light and depth along it, on three
// perpendicular axes. For a directional light all three are metres. For a lamp, depth is metres
// from the lamp's plane, and u and v are metres at a depth of one metre.
typedef struct LightView {
    double axis[3][3]; // unit: of u, of v, of depth
    double origin[3];  // m
    bool perspective;
} LightView;

// A lamp looks at `middle` (world, m).
LightView light_frame_view(const Light *light, const float middle[3]);

// Row k of the matrix that turns (x, y, z, 1) into (u w, v w, depth, w).
void light_frame_row(const LightView *view, int k, double row[4]);

// Fills in place: u, v, depth. `x`: world, m. False if the point is behind the light.
bool light_frame_place(const LightView *view, const double x[3], double place[3]);

// Limits of u and v. A lamp's map ends 75 degrees off its axis. For directional lights, points more
// than 1,000 km away count as broken.
#define LIGHT_FRAME_FAR  1e6
#define LIGHT_FRAME_WIDE 3.7

typedef struct LightFrame {
    double rows[4][4]; // by which (x, y, z, 1) becomes (u w, v w, depth, w): u and v in texels of
                       // the map, depth 0..1
    double texel;      // side of a texel: m; for a lamp, m at a depth of one metre
    double depth[2];   // m: depths that the map stores as 0 and 1
} LightFrame;

// The window around `box` (lowest u, v, depth, then the highest, as in LightView), in a map of
// `side` texels of which `margin` stay free at each edge. The window's size changes in steps of
// a factor of 2^(1/8) and its middle by whole texels, so that shadows do not swim from frame to
// frame. Depths are linear. Their range is a little larger than the box and also changes in steps.
LightFrame light_frame_steady(const LightView *view, const double box[6], int side, int margin);

// The same window with depths as OpenGL draws them: for a lamp they are linear on the screen.
LightFrame light_frame_drawn(const LightView *view, const double box[6], int side, int margin);
