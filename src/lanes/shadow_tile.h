// SPDX-License-Identifier: MIT
// Tiles of strands that stand in a light, one strand a lane, for shadow_map.c, shadow_light.c and
// shadow_points.c.
#pragma once

#include "base/simd.h"
#include "lanes/mapped_caster.h"

enum { W = STRAND_TILE, LAYERS = SHADOW_LAYERS };

// Where a point of each strand lies before the light, and its radius (m).
typedef struct Places {
    float u[W], v[W], z[W], w[W], radius[W];
} Places;

// One tile of one caster.
typedef struct Tile {
    const MappedCaster *caster;
    size_t number;
    int strands; // that are drawn
    float radius[W], opacity[W];
} Tile;

// Particle j of a tile's first strand; the others' follow.
static inline size_t tile_particle(const Tile *tile, int j)
{
    return (tile->number * tile->caster->material.vertex_count + (size_t)j) * W;
}

// How far centripetal knots lie apart: the root of their particles' distance.
SIMD_INLINE float knot_after(float way[3][W], int i)
{
    float square = way[0][i] * way[0][i] + way[1][i] * way[1][i] + way[2][i] * way[2][i];
    return simd_max(sqrtf(sqrtf(square)), 1e-9f);
}

// The ways from particle j of the tile's strands to the next, metres.
SIMD_INLINE void find_ways(const Tile *tile, int j, float ways[3][W])
{
    const float(*from)[4] = tile->caster->position + tile_particle(tile, j), (*to)[4] = from + W;
    for (int c = 0; c < 3; ++c)
        for (int i = 0; i < W; ++i) ways[c][i] = to[i][c] - from[i][c];
}

// A segment of the curves through a tile's strands: where it begins, the ways before, along and
// after it, and what Hermite's weights have in common.
typedef struct CurveSegment {
    float start[3][W], ways[3][3][W];
    float from[W], to[W], before[W], after[W];
} CurveSegment;

// Before the root and behind the tip stands the neighbour's mirror image, so that the missing way
// is the segment's own.
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
        float before = knot_after(segment->ways[0], i), own = knot_after(segment->ways[1], i),
              after = knot_after(segment->ways[2], i);
        segment->from[i] = own / (before + own);
        segment->to[i] = own / (own + after);
        segment->before[i] = own / before;
        segment->after[i] = own / after;
    }
}

// The points at t (0 to 1) of a segment, as curve_point of glsl/draw/curve.glsl: its first end and
// a weighted sum of the three ways.
SIMD_INLINE void find_on_segment(const CurveSegment *segment, bool spline, float t, float x[3][W])
{
    float s = 1 - t, weight[3][W];
    if (spline) { // the B-spline's basis, its four weights' sum taken out
        float before = -s * s * s / 6, after = t * t * t / 6,
              own = ((3 * s - 6) * s * s + 4) / 6 + after;
        for (int i = 0; i < W; ++i) weight[0][i] = before, weight[1][i] = own, weight[2][i] = after;
    } else { // Hermite's, of tangents as curve_tangents has them
        float end = (3 - 2 * t) * t * t, tangent_from = t * s * s, tangent_to = -t * t * s;
        for (int i = 0; i < W; ++i) {
            float from = segment->from[i], to = segment->to[i];
            weight[0][i] = tangent_from * (segment->before[i] - from);
            weight[1][i] = end + tangent_from * (1 - from) + tangent_to * (1 - to);
            weight[2][i] = tangent_to * (segment->after[i] - to);
        }
    }
    for (int c = 0; c < 3; ++c)
        for (int i = 0; i < W; ++i)
            x[c][i] = segment->start[c][i] + weight[0][i] * segment->ways[0][c][i] +
                      weight[1][i] * segment->ways[1][c][i] + weight[2][i] * segment->ways[2][c][i];
}

// Point k of each strand in the world: `own` where the caster has no points found before.
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

// The radius that the paint of a particle has, as a share of the material's.
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

// Points x of the tile's strands as the light sees them. What lies beside a lamp or behind it goes
// far away.
SIMD_INLINE void project_points(const CastParams *params, const float x[3][W], Places *places)
{
    const float(*rows)[4] = (const float(*)[4])params->from_world;
    for (int k = 0; k < W; ++k) {
        float p = x[0][k], q = x[1][k], r = x[2][k];
        float w = rows[3][0] * p + rows[3][1] * q + rows[3][2] * r + rows[3][3],
              inverse = 1 / simd_max(w, 1e-6f);
        float u = rows[0][0] * p + rows[0][1] * q + rows[0][2] * r + rows[0][3],
              v = rows[1][0] * p + rows[1][1] * q + rows[1][2] * r + rows[1][3];
        places->u[k] = w > 0 ? u * inverse : -1e6f;
        places->v[k] = w > 0 ? v * inverse : -1e6f;
        places->z[k] = rows[2][0] * p + rows[2][1] * q + rows[2][2] * r + rows[2][3];
        places->w[k] = simd_max(w, 1e-6f);
    }
}

// Point k of the tile's strands.
SIMD_INLINE void find_places(const CastParams *params, const Tile *tile, int k, Places *places)
{
    float own[3][W];
    project_points(params, find_points(tile, k, own), places);
    find_radii(tile, k, places->radius);
}

// The tile of a caster whose turn it is.
static inline Tile open_tile(const MappedCaster *caster, int turn)
{
    const MaterialParams *material = &caster->material;
    int number = (int)mapped_caster_tile(caster, turn), first = number * W,
        left = (int)material->drawn_strands - first;
    Tile tile = {.caster = caster, .number = (size_t)number, .strands = left < W ? left : W};
    for (int k = 0; k < W; ++k) {
        bool last = first + k == (int)material->last_strand;
        tile.radius[k] = material->radius * (last ? material->last_share : 1);
        uint32_t bits =
            caster->paint ? caster->paint[tile_particle(&tile, 0) + (size_t)k][1] >> 16 : 0xffff;
        tile.opacity[k] = material->shadow_opacity * (float)bits / 65535;
    }
    return tile;
}

// The tiles of a caster, from range[0] to before range[1], that one of `parts` threads works on.
static inline void find_range(const MappedCaster *caster, int part, int parts, int range[2])
{
    int64_t tiles = ((int64_t)caster->material.drawn_strands + W - 1) / W;
    range[0] = (int)(tiles * part / parts);
    range[1] = (int)(tiles * (part + 1) / parts);
}
