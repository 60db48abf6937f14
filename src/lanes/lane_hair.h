// SPDX-License-Identifier: MIT
// The hair of an image, in the CPU's memory, and the numbering of its points.
#pragma once

#include "draw/mapped_caster.h"

#include "glsl/draw/draw.h"
#include "glsl/kernel/curve.h"

#include <stdbool.h>

// One batch.
typedef struct LaneHair {
    MappedCaster caster;
    const uint32_t *ids;         // [slots]: seeds of random variations by strand
    const struct LaneLook *look; // how it is shaded, see shade.h
    uint32_t points;             // per strand: its particles, or the points of its curve
    size_t tiles, first_tile; // number of tiles of STRAND_TILE strands, and of all previous batches
    size_t first_point;       // number of points of all previous batches: [strand][point]
} LaneHair;

// All hair of an image.
typedef struct LaneHairs {
    const LaneHair *list;
    uint32_t count;
    size_t tiles, points; // of all batches: points less than 2^32
} LaneHairs;

// Point k of a strand, m: from the table of points, or, if there are too many points to keep,
// computed here.
static inline void lane_hair_point(const LaneHair *hair, uint32_t strand, uint32_t k, float x[3])
{
    const MappedCaster *caster = &hair->caster;
    size_t tile = strand / STRAND_TILE, lane = strand % STRAND_TILE;
    uint32_t n = caster->material.vertex_count, parts = caster->material.smooth_parts,
             j = k / parts < n - 1 ? k / parts : n - 2;
    float ways[3][3], knot[3], t = (float)(k - j * parts) / (float)parts;
    if (caster->points) {
        for (int c = 0; c < 3; ++c) x[c] = caster->points[tile * hair->points + k][c][lane];
        return;
    }
    const float(*at)[4] = caster->position + (tile * n + j) * STRAND_TILE + lane;
    for (int i = 0; i < 3; ++i) { // before, along and after the segment
        bool own = i == 1 || (i == 0 && j == 0) || (i == 2 && j == n - 2);
        const float(*from)[4] = own ? at : i == 0 ? at - STRAND_TILE : at + STRAND_TILE;
        for (int c = 0; c < 3; ++c) ways[i][c] = from[STRAND_TILE][c] - from[0][c];
        knot[i] = curve_knot(ways[i][0], ways[i][1], ways[i][2]);
    }
    CurveWeights weights = caster->material.smooth_curve
                               ? curve_spline(t)
                               : curve_hermite(curve_knots(knot[0], knot[1], knot[2]), t);
    if (parts == 1) weights = (CurveWeights){0, t, 0};
    for (int c = 0; c < 3; ++c)
        x[c] = at[0][c] + weights.before * ways[0][c] + weights.own * ways[1][c] +
               weights.after * ways[2][c];
}

// The batch to which a point belongs.
static inline const LaneHair *lane_hair_of(const LaneHairs *hairs, size_t point)
{
    uint32_t i = 0;
    while (i + 1 < hairs->count && point >= hairs->list[i + 1].first_point) ++i;
    return &hairs->list[i];
}
