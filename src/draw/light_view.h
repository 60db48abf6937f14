// SPDX-License-Identifier: MIT
// How a light sees the world: what its shadow maps are drawn from.
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
LightView light_view(const Light *light, const float middle[3]);

// Row k of the matrix by which (x, y, z, 1) becomes (u w, v w, depth, w).
void light_view_row(const LightView *view, int k, double row[4]);

// place: u, v, depth. `x`: world, m. False if it does not lie before the light.
bool light_view_place(const LightView *view, const double x[3], double place[3]);
