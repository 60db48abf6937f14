// SPDX-License-Identifier: MIT
// The floor at 16 px: either a matt plane, lit as the mesh is, or only its shadow, as black with an
// alpha. For base_draw.c.
#pragma once

#include "lanes/base_light.h"
#include "scene/floor.h"

#include "glsl/common/shared_math.h"

enum { FLOOR_TAPS = 6 }; // as soft as shadows on hair, whose maps are coarser

typedef struct BaseFloor {
    FloorKind kind; // none: no floor is visible
    const LaneShadow *shadow;
    float middle[3], whole, faded, hides;
    float color[3]; // linear
} BaseFloor;

// A floor is visible from above only.
static inline BaseFloor base_floor(const Floor *floor, const LaneShadow *shadow,
                                   const DrawParams *draw)
{
    BaseFloor base = {.shadow = shadow,
                      .kind = draw->eye[1] > floor->middle[1] ? floor->kind : FLOOR_NONE,
                      .whole = floor->whole,
                      .faded = floor->faded,
                      .hides = floor_hides(floor->whole, floor->faded)};
    memcpy(base.middle, floor->middle, sizeof base.middle);
    linear_from_srgb_color(floor->color, base.color);
    return base;
}

typedef struct BaseFloorPoints {
    float x[3][W];            // m
    float off[W];             // m from the floor's middle; INFINITY if the ray does not meet it
    float there[W], depth[W]; // the floor's opacity and depth there (0 .. 1)
} BaseFloorPoints;

// Finds the points of the floor that 16 px from (x, y) on show. Returns whether there are any.
SIMD_INLINE bool base_floor_find(const BaseFloor *floor, const BaseView *view, int x, int y,
                                 BaseFloorPoints *points)
{
    const DrawParams *draw = view->draw;
    float way[3][W], most = 0;
    base_ways(view, x, y, way);
    for (int k = 0; k < W; ++k) {
        float along = (floor->middle[1] - draw->eye[1]) / way[1][k];
        bool before = along > 0;
        along = before ? along : 1;
        for (int c = 0; c < 3; ++c) points->x[c][k] = draw->eye[c] + along * way[c][k];
        float p = points->x[0][k] - floor->middle[0], r = points->x[2][k] - floor->middle[2],
              off = sqrtf(p * p + r * r), there = floor_there(off, floor->whole, floor->faded);
        points->off[k] = before ? off : INFINITY;
        points->there[k] = before ? there : 0;
        points->depth[k] = edge_depth_at(draw->depth[0], draw->depth[1], along);
    }
    for (int k = 0; k < W; ++k) {
        points->depth[k] = points->there[k] > 0 ? points->depth[k] : EDGE_NOWHERE;
        most = simd_max(points->there[k], most);
    }
    return most > 0;
}

// shown: linear light and opacity, premultiplied.
SIMD_INLINE void base_floor_shade(const BaseFloor *floor, const BaseView *view,
                                  const BaseFloorPoints *points, float shown[4][W])
{
    const DrawParams *draw = view->draw;
    float normal[3][W], left[MAX_LIGHTS][W], to_light[3][W], share[W], light[3][W], sent[3][W];
    for (int k = 0; k < W; ++k) normal[0][k] = normal[2][k] = 0, normal[1][k] = 1;
    for (int c = 0; c < 3; ++c) {
        base_around(draw, c, (const float(*)[W])normal, light[c]);
        for (int k = 0; k < W; ++k) light[c][k] = sent[c][k] = draw->mesh_color[3] * light[c][k];
    }
    base_left(floor->shadow, draw->light_count, points->x, (const float(*)[W])normal, 0, FLOOR_TAPS,
              left);
    for (int i = 0; i < draw->light_count; ++i) {
        lamp_find(draw, i, points->x, to_light, share);
        for (int c = 0; c < 3; ++c)
            for (int k = 0; k < W; ++k) {
                float all = draw->light_color[i][c] * share[k] * simd_max(to_light[1][k], 0);
                sent[c][k] += all;
                light[c][k] += all * left[i][k];
            }
    }
    bool catches = floor->kind == FLOOR_SHADOW;
    for (int k = 0; k < W; ++k) {
        float lacks = floor_shadow(floor_luminance(light[0][k], light[1][k], light[2][k]),
                                   floor_luminance(sent[0][k], sent[1][k], sent[2][k])),
              there = points->there[k];
        for (int c = 0; c < 3; ++c)
            shown[c][k] = catches ? 0 : there * (floor->color[c] * light[c][k]);
        shown[3][k] = catches ? there * lacks : there;
    }
}

// A plane hides what is behind it if at least half of it is opaque.
SIMD_INLINE void base_floor_hide(const BaseFloor *floor, const BaseFloorPoints *points,
                                 float depth[W])
{
    bool plane = floor->kind == FLOOR_PLANE;
    for (int k = 0; k < W; ++k) {
        float own = simd_max(points->depth[k], 0);
        depth[k] = plane && points->off[k] < floor->hides ? simd_min(own, depth[k]) : depth[k];
    }
}
