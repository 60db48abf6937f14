// SPDX-License-Identifier: MIT
// Light on 16 points of mesh or floor, shown by 16 pixels side by side. For base_draw.c and
// base_mesh.c.
#pragma once

#include "base/simd.h"
#include "draw/rays.h"
#include "lanes/lamp.h"
#include "lanes/shadow.h"

#include "glsl/draw/draw.h"
#include "glsl/kernel/edge.h"
#include "glsl/kernel/floor.h"

enum { W = 16 };

// The camera.
typedef struct BaseView {
    const DrawParams *draw;
    Rays rays;
} BaseView;

// The vectors from the eye through the middles of 16 px from (x, y) on.
SIMD_INLINE void base_ways(const BaseView *view, int x, int y, float way[3][W])
{
    const Rays *rays = &view->rays;
    float column = (float)x + 0.5f, row = (float)y + 0.5f;
    for (int c = 0; c < 3; ++c) {
        float from = rays->down[c] * row + rays->from[c], across = rays->across[c];
        for (int k = 0; k < W; ++k) way[c][k] = across * (column + (float)k) + from;
    }
}

// The mean light from everywhere, of a channel, on surfaces with these unit normals.
SIMD_INLINE void base_around(const DrawParams *draw, int c, const float n[3][W], float light[W])
{
    const float(*a)[4] = (const float(*)[4])draw->around;
    for (int k = 0; k < W; ++k) light[k] = lamp_around(draw->sky[c], draw->ground[c], n[1][k]);
    for (int k = 0; a[0][3] > 0 && k < W; ++k)
        light[k] = simd_max(
            light[k] + lamp_aside(a[0][c], a[1][c], n[0][k], n[2][k]) +
                lamp_bent(a[2][c], a[3][c], a[4][c], a[5][c], a[6][c], n[0][k], n[1][k], n[2][k]),
            0);
}

// The share of each of the first `lights` lights that reaches points x of surfaces with these unit
// normals: see lane_shadow_left_on. `shadow` may be NULL.
SIMD_INLINE void base_left(const LaneShadow *shadow, int lights, const float x[3][W],
                           const float normal[3][W], float wrap, int taps,
                           float left[MAX_LIGHTS][W])
{
    float of_map[MAX_LIGHTS][W];
    if (shadow) lane_shadow_left_on(shadow, x, normal, wrap, taps, of_map);
    for (int i = 0; i < lights; ++i) {
        int map = shadow ? shadow->map_of[i] : -1;
        for (int k = 0; k < W; ++k) left[i][k] = map < 0 ? 1 : of_map[map][k];
    }
}
