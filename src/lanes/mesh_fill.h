// SPDX-License-Identifier: MIT
// Fills one triangle: depths and the values beside them, 16 px at once. For mesh_raster_draw.c.
#pragma once

#include "base/simd.h"
#include "lanes/mesh_raster.h"

#include <stdbool.h>

enum {
    W = 16,
    STEPS = 256, // per px
    BAND = 16,   // rows that a thread processes at once
    PLACES = 1 + MESH_EDGES,
    NORMAL = 2,
    TINT = NORMAL + 3,
    VALUES = TINT + 4 // per vertex: depth, 1/w, normal / w, tint / w
};

// The places of the middle sample and of the edge samples in a pixel (1/256 px). The edge samples
// are at llvmpipe's places.
static const int PLACE[PLACES][2] = {{128, 128}, {96, 32}, {224, 96}, {32, 160}, {160, 224}};

// The planes that are written.
typedef struct MeshPlanes {
    int width, height, pitch, parts;
    float *depth[PLACES]; // [height][pitch]; only the first if only depths are written
    float *value[VALUES]; // the same at pixels' middles; [0] is unused
} MeshPlanes;

typedef struct Corner {
    int place[2]; // 1/256 px
    float value[VALUES];
} Corner;

// A value that is linear on the screen: at a corner, and its change with each px.
typedef struct Slope {
    float from, x, y;
} Slope;

static int least(int a, int b, int c)
{
    int low = a < b ? a : b;
    return low < c ? low : c;
}

static int most(int a, int b, int c)
{
    return -least(-a, -b, -c);
}

// The first and last px before `end` that have a sample in the triangle.
static void find_range(const Corner *const c[3], int axis, bool edges, int end, int range[2])
{
    int low = least(c[0]->place[axis], c[1]->place[axis], c[2]->place[axis]),
        high = most(c[0]->place[axis], c[1]->place[axis], c[2]->place[axis]),
        first = edges ? 32 : 128, last = edges ? 224 : 128; // of PLACE
    range[0] = (low - last + STEPS - 1) >> 8;
    range[1] = (high - first) >> 8;
    if (range[0] < 0) range[0] = 0;
    if (range[1] > end - 1) range[1] = end - 1;
}

// Uses double precision, because a narrow triangle's slopes are differences of nearly equal
// numbers.
static Slope find_slope(const Corner *const c[3], int value, double over_area)
{
    double along = (double)(c[1]->value[value] - c[0]->value[value]) * over_area,
           across = (double)(c[2]->value[value] - c[0]->value[value]) * over_area;
    return (Slope){.from = c[0]->value[value],
                   .x = (float)(along * (c[2]->place[1] - c[0]->place[1]) -
                                across * (c[1]->place[1] - c[0]->place[1])),
                   .y = (float)(across * (c[1]->place[0] - c[0]->place[0]) -
                                along * (c[2]->place[0] - c[0]->place[0]))};
}

SIMD_INLINE float slope_at(const Slope *slope, const Corner *corner, const int place[2], int x,
                           int y)
{
    return slope->from +
           slope->x * ((float)(x * STEPS + place[0] - corner->place[0]) * (1.0f / STEPS)) +
           slope->y * ((float)(y * STEPS + place[1] - corner->place[1]) * (1.0f / STEPS));
}

// Threads take the bands of rows in turn.
SIMD_INLINE bool is_mine(const MeshPlanes *to, int part, int band)
{
    return band % to->parts == part;
}

static bool any_is_mine(const MeshPlanes *to, int part, const int rows[2])
{
    int first = rows[0] / BAND, last = rows[1] / BAND;
    return last - first + 1 >= to->parts ||
           (part - first % to->parts + to->parts) % to->parts <= last - first;
}

// One sample of 16 px: writes the depth where the triangle is nearer, and returns where.
SIMD_INLINE void fill_place(const int edge[3], const int (*steps)[W], float from, float step,
                            float *depth, int hit[W])
{
    for (int k = 0; k < W; ++k) {
        int outside = (edge[0] + steps[0][k]) | (edge[1] + steps[1][k]) | (edge[2] + steps[2][k]);
        float z = from + step * (float)k;
        hit[k] = (outside >= 0) & (z < depth[k]);
        depth[k] = hit[k] ? z : depth[k];
    }
}

// A triangle, ready to be filled from px `first` of row `top` on.
typedef struct Setup {
    int first, top, last[2];             // last column and row
    int steps[3][W];                     // see set_up: offsets of lanes for each edge
    int64_t edges[W], down[W], along[W]; // [place][3]: at the first px; change per row, per 16 px
    float depth[PLACES], value[VALUES];  // at the first px
    Slope slopes[VALUES];                // for each px
} Setup;

// The sign of E = dx (y - y0) - dy (x - x0) tells on which side of an edge from (x0, y0) a sample
// lies; one on it belongs to the triangle on its left or below it. A step of one px changes
// floor(E / 256) by -dy or dx, exactly. False if this part has nothing to fill.
SIMD_INLINE bool set_up(const MeshPlanes *to, int part, const Corner *const corners[3],
                        bool surface, Setup *setup)
{
    const int places = surface ? PLACES : 1, values = surface ? VALUES : 1;
    const Corner *corner[3] = {corners[0], corners[1], corners[2]};
    const int *a = corner[0]->place, *b = corner[1]->place, *c = corner[2]->place;
    int rows[2], columns[2];
    find_range(corners, 1, surface, to->height, rows);
    find_range(corners, 0, surface, to->width, columns);
    if (rows[0] > rows[1] || columns[0] > columns[1]) return false;
    if (!any_is_mine(to, part, rows)) return false;
    int64_t area = (int64_t)(b[0] - a[0]) * (c[1] - a[1]) - (int64_t)(c[0] - a[0]) * (b[1] - a[1]);
    if (area == 0) return false;
    if (area < 0) area = -area, corner[1] = corners[2], corner[2] = corners[1];
    setup->first = columns[0] / W * W;
    setup->top = rows[0];
    setup->last[0] = columns[1];
    setup->last[1] = rows[1];
    for (int i = 0; i < W; ++i) setup->edges[i] = setup->down[i] = setup->along[i] = 0;
    for (int e = 0; e < 3; ++e) {
        const int *from = corner[e]->place, *next = corner[(e + 1) % 3]->place;
        int dx = next[0] - from[0], dy = next[1] - from[1], own = dy < 0 || (dy == 0 && dx > 0);
        for (int k = 0; k < W; ++k) setup->steps[e][k] = -dy * k;
        for (int p = 0; p < places; ++p) {
            int64_t at = (int64_t)dx * (setup->top * STEPS + PLACE[p][1] - from[1]) -
                         (int64_t)dy * (setup->first * STEPS + PLACE[p][0] - from[0]);
            setup->edges[3 * p + e] = (at - !own) >> 8;
            setup->down[3 * p + e] = dx;
            setup->along[3 * p + e] = -dy * (int64_t)W;
        }
    }
    for (int i = 0; i < values; ++i) {
        Slope *slope = &setup->slopes[i];
        *slope = find_slope(corner, i, (double)STEPS / (double)area);
        setup->value[i] = slope_at(slope, corner[0], PLACE[0], setup->first, setup->top);
    }
    for (int p = 0; p < places; ++p)
        setup->depth[p] =
            slope_at(&setup->slopes[0], corner[0], PLACE[p], setup->first, setup->top);
    return true;
}

// `edges`: of the first px of row y.
SIMD_INLINE void fill_row(const MeshPlanes *to, const Setup *setup, const int64_t edges[W], int y,
                          bool surface)
{
    const int places = surface ? PLACES : 1, values = surface ? VALUES : 1;
    const int64_t bound = 1 << 30;
    const float down = (float)(y - setup->top);
    for (int x = setup->first, turn = 0; x <= setup->last[0]; x += W, ++turn) {
        size_t at = (size_t)y * (size_t)to->pitch + (size_t)x;
        int edge[W], hit[W], seen[W];
        float right = (float)(turn * W), depth = setup->slopes[0].x * right;
        depth += setup->slopes[0].y * down;
        for (int i = 0; i < W; ++i) {
            int64_t here = edges[i] + turn * setup->along[i], low = here > -bound ? here : -bound;
            edge[i] = (int)(low < bound ? low : bound);
        }
        for (int p = 0; p < places; ++p) {
            int *of_place = p ? hit : seen; // cppcheck-suppress legacyUninitvar ; set below
            fill_place(edge + 3 * p, setup->steps, setup->depth[p] + depth, setup->slopes[0].x,
                       to->depth[p] + at, of_place);
        }
        for (int i = 1; i < values; ++i) {
            const Slope *slope = &setup->slopes[i];
            float from = setup->value[i] + slope->x * right + slope->y * down, step = slope->x,
                  *value = to->value[i] + at;
            // cppcheck-suppress uninitvar ; fill_place has set it
            for (int k = 0; k < W; ++k) value[k] = seen[k] ? from + step * (float)k : value[k];
        }
    }
}

SIMD_INLINE void fill_triangle(const MeshPlanes *to, int part, const Corner *const corner[3],
                               bool surface)
{
    Setup setup;
    if (!set_up(to, part, corner, surface, &setup)) return;
    for (int band = setup.top / BAND; band <= setup.last[1] / BAND; ++band) {
        if (!is_mine(to, part, band)) continue;
        int64_t edges[W];
        int first = band * BAND, end = first + BAND;
        if (first < setup.top) first = setup.top;
        if (end > setup.last[1] + 1) end = setup.last[1] + 1;
        for (int i = 0; i < W; ++i) edges[i] = setup.edges[i] + (first - setup.top) * setup.down[i];
        for (int y = first; y < end; ++y) {
            fill_row(to, &setup, edges, y, surface);
            for (int i = 0; i < W; ++i) edges[i] += setup.down[i];
        }
    }
}
