// SPDX-License-Identifier: MIT
// Tiles of strands, one strand for each lane, for passes over all hair.
#pragma once

#include "base/simd.h"
#include "draw/mapped_caster.h"

#include "glsl/kernel/caster.h"
#include "glsl/kernel/curve.h"

enum { W = STRAND_TILE, LAYERS = SHADOW_LAYERS };

// The place of a point of each strand as the light sees it, and its radius (m).
typedef struct SIMD_ALIGNED Places {
    float u[W], v[W], z[W], w[W], radius[W];
} Places;

// One tile of one caster.
typedef struct Tile {
    const MappedCaster *caster;
    size_t number;
    int strands;                 // number of strands that are drawn
    float radius[W], opacity[W]; // m; opacity to light
    float share[W];              // a factor of all opacities
} Tile;

// Particle j of a tile's first strand; those of the other strands follow.
static inline size_t tile_particle(const Tile *tile, int j)
{
    return (tile->number * tile->caster->material.vertex_count + (size_t)j) * W;
}

// The vectors from particle j of the tile's strands to the next particle, metres.
SIMD_INLINE void find_ways(const Tile *tile, int j, float ways[3][W])
{
    const float(*from)[4] = tile->caster->position + tile_particle(tile, j), (*to)[4] = from + W;
    for (int c = 0; c < 3; ++c)
        for (int i = 0; i < W; ++i) ways[c][i] = to[i][c] - from[i][c];
}

// A segment of the curves through a tile's strands: its first end, the vectors before, along and
// after it, and the part of Hermite's weights that all of its points share.
typedef struct SIMD_ALIGNED CurveSegment {
    float start[3][W], ways[3][3][W];
    float before[W], from[W], to[W], after[W]; // CurveKnots
} CurveSegment;

SIMD_INLINE void open_segment(const Tile *tile, int j, CurveSegment *segment)
{
    int last = (int)tile->caster->material.vertex_count - 2;
    const float(*start)[4] = tile->caster->position + tile_particle(tile, j);
    for (int n = 0; n < 3; ++n) {
        int from = j - 1 + n;
        find_ways(tile, from < 0 || from > last ? j : from, segment->ways[n]);
    }
    for (int c = 0; c < 3; ++c)
        for (int i = 0; i < W; ++i) segment->start[c][i] = start[i][c];
    if (tile->caster->material.smooth_curve) return;
    for (int i = 0; i < W; ++i) {
        float knot[3];
        for (int n = 0; n < 3; ++n)
            knot[n] =
                curve_knot(segment->ways[n][0][i], segment->ways[n][1][i], segment->ways[n][2][i]);
        CurveKnots knots = curve_knots(knot[0], knot[1], knot[2]);
        segment->before[i] = knots.before, segment->from[i] = knots.from;
        segment->to[i] = knots.to, segment->after[i] = knots.after;
    }
}

// The points at t (0 to 1) of a segment (kernel/curve.h).
SIMD_INLINE void find_on_segment(const CurveSegment *segment, bool spline, float t, float x[3][W])
{
    float weight[3][W];
    for (int i = 0; i < W; ++i) {
        CurveKnots knots = {segment->before[i], segment->from[i], segment->to[i],
                            segment->after[i]};
        CurveWeights weights = spline ? curve_spline(t) : curve_hermite(knots, t);
        weight[0][i] = weights.before, weight[1][i] = weights.own, weight[2][i] = weights.after;
    }
    for (int c = 0; c < 3; ++c)
        for (int i = 0; i < W; ++i)
            x[c][i] = segment->start[c][i] + weight[0][i] * segment->ways[0][c][i] +
                      weight[1][i] * segment->ways[1][c][i] + weight[2][i] * segment->ways[2][c][i];
}

// Point k of each strand in the world; `own` receives it if the caster has no table of points.
SIMD_INLINE const float (*find_points(const Tile *tile, int k, float own[3][W]))[W]
{
    const MappedCaster *caster = tile->caster;
    int parts = (int)caster->material.smooth_parts, last = (int)caster->material.vertex_count - 2;
    if (caster->points)
        return caster->points[tile->number * (size_t)mapped_caster_points(caster) + (size_t)k];
    if (parts == 1) {
        const float(*x)[4] = caster->position + tile_particle(tile, k);
        for (int c = 0; c < 3; ++c)
            for (int i = 0; i < W; ++i) own[c][i] = x[i][c];
    } else {
        CurveSegment segment;
        int j = k / parts < last ? k / parts : last;
        open_segment(tile, j, &segment);
        find_on_segment(&segment, caster->material.smooth_curve != 0,
                        (float)(k - j * parts) / (float)parts, own);
    }
    return (const float(*)[W])own;
}

// The radius of a particle by its paint, as a share of the material's radius.
SIMD_INLINE float share_of(const Tile *tile, size_t particle)
{
    return simd_float_of(tile->caster->paint[particle][2]);
}

SIMD_INLINE void find_radii(const Tile *tile, int k, float radius[W])
{
    const MaterialParams *material = &tile->caster->material;
    int parts = (int)material->smooth_parts;
    float thinning = (1 - material->tip_ratio) / (float)(material->vertex_count - 1),
          share = 1 - thinning * ((float)k / (float)parts), on = (float)(k % parts) / (float)parts;
    size_t at = tile_particle(tile, k / parts), next = on > 0 ? at + W : at;
    for (int i = 0; i < W; ++i) radius[i] = simd_max(tile->radius[i] * share, 1e-9f);
    for (int i = 0; tile->caster->paint && i < W; ++i) {
        float here = share_of(tile, at + (size_t)i), there = share_of(tile, next + (size_t)i);
        radius[i] = simd_max(tile->radius[i] * (here + on * (there - here)), 1e-9f);
    }
}

// Points x of the tile's strands as the light sees them.
SIMD_INLINE void project_points(const CastParams *params, const float x[3][W], Places *places)
{
    const float(*rows)[4] = (const float(*)[4])params->from_world;
    for (int k = 0; k < W; ++k) {
        CasterPlace place = caster_place(rows, x[0][k], x[1][k], x[2][k]);
        places->u[k] = place.u, places->v[k] = place.v;
        places->z[k] = place.z, places->w[k] = place.w;
    }
}

// A tile of a caster, by its number or by its place in the order.
static inline Tile open_tile_at(const MappedCaster *caster, size_t number)
{
    const MaterialParams *material = &caster->material;
    int first = (int)number * W, left = (int)material->drawn_strands - first;
    Tile tile = {.caster = caster, .number = number, .strands = left < W ? left : W};
    for (int k = 0; k < W; ++k) {
        bool last = first + k == (int)material->last_strand;
        tile.radius[k] = material->radius * (last ? material->last_share : 1);
        uint32_t bits =
            caster->paint ? caster->paint[tile_particle(&tile, 0) + (size_t)k][1] >> 16 : 0xffff;
        tile.share[k] = (float)bits / 65535;
        tile.opacity[k] = material->shadow_opacity * tile.share[k];
    }
    return tile;
}

static inline Tile open_tile(const MappedCaster *caster, int turn)
{
    return open_tile_at(caster, mapped_caster_tile(caster, turn));
}

// The tiles of a caster, from range[0] to before range[1], that one of `parts` threads works on.
static inline void find_range(const MappedCaster *caster, int part, int parts, int range[2])
{
    int64_t tiles = ((int64_t)caster->material.drawn_strands + W - 1) / W;
    range[0] = (int)(tiles * part / parts);
    range[1] = (int)(tiles * (part + 1) / parts);
}
