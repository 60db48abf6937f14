// SPDX-License-Identifier: MIT
#include "lanes/shadow_splat.h"

#include "lanes/shadow_tile.h"

#include "glsl/kernel/caster.h"

#include <stdlib.h>
#include <string.h>

static const float MOST = 7500; // most points of a wide segment, as in shadow_splat.comp

// Segments of a tile's strands as rows of points: `count` points beginning at (u, v, z).
typedef struct SIMD_ALIGNED Points {
    float u[W], v[W], z[W], step_u[W], step_v[W], step_z[W];
    float along[W], width[W];
    uint32_t part[W]; // see caster_part
    int count[W];     // of thin ribbons; 0 for wide ones
    int most;         // the largest count
    bool wide;        // some ribbon is wide and needs several points across
} Points;

static float dense_wide(const ShadowSplat *splat)
{
    return splat->depths ? CASTER_DEEP_WIDE : CASTER_FIRST_WIDE;
}

// How a ribbon is covered with points: in a row along it and, if it is wide, also across. Thin
// ribbons are not resolved; fibre_depth gives their opacity.
SIMD_INLINE void lay_points(const ShadowSplat *splat, int map, const Tile *tile, float weight,
                            const Places *a, const Places *b, Points *points)
{
    float texels = splat->params[map].texels, unit = splat->params[map].unit * weight;
    float thin = splat->depths   ? CASTER_DEEP
                 : splat->coarse ? CASTER_COARSE
                                 : CASTER_FIRST,
          wide = dense_wide(splat),
          slack = splat->depths || !splat->coarse ? 0 : CASTER_COARSE_SLACK;
    int most = 0;
    float widest = 0;
    for (int k = 0; k < W; ++k) {
        float u = b->u[k] - a->u[k], v = b->v[k] - a->v[k], z = b->z[k] - a->z[k];
        float size = sqrtf(u * u + v * v),
              width = caster_width(texels, a->radius[k], b->radius[k], a->w[k], b->w[k]);
        float along = caster_along(size, width > CASTER_WIDE ? wide : thin, slack),
              inverse = 1 / along;
        points->step_u[k] = u * inverse;
        points->step_v[k] = v * inverse;
        points->step_z[k] = z * inverse;
        points->u[k] = a->u[k] + 0.5f * points->step_u[k];
        points->v[k] = a->v[k] + 0.5f * points->step_v[k];
        points->z[k] = a->z[k] + 0.5f * points->step_z[k];
        points->along[k] = along;
        points->width[k] = width;
        points->part[k] = caster_part(tile->opacity[k], width, size, unit, along);
        bool is_thin = (k < tile->strands) & (width <= CASTER_WIDE);
        points->count[k] = is_thin ? (int)along : 0;
    }
    for (int k = 0; k < W; ++k) most = points->count[k] > most ? points->count[k] : most;
    for (int k = 0; k < W; ++k) widest = simd_max(points->width[k], widest);
    points->most = most;
    points->wide = widest > CASTER_WIDE;
}

// Where point `turn` of strand k lies. Outside the map it is clamped to the edge and `inside` is
// false.
typedef struct Spot {
    float z;
    int row, column;
    bool inside;
} Spot;

SIMD_INLINE Spot find_spot(const Points *points, int k, int turn, float edge)
{
    float u = points->u[k] + (float)turn * points->step_u[k],
          v = points->v[k] + (float)turn * points->step_v[k],
          z = points->z[k] + (float)turn * points->step_z[k];
    float x = simd_min(simd_max(u, 0), edge), y = simd_min(simd_max(v, 0), edge);
    return (Spot){.z = z,
                  .row = (int)y,
                  .column = (int)x,
                  .inside = (u == x) & (v == y) & (turn < points->count[k])};
}

// A queue of points to add. Their places are computed beforehand, so that the additions do not wait
// for each other.
enum { QUEUE = 2048 };
typedef struct SIMD_ALIGNED Queue {
    int place[QUEUE];
    uint32_t part[QUEUE];
    int count;
} Queue;

// The data of one drawing thread.
typedef struct Brush {
    const ShadowSplat *splat;
    uint32_t *sums; // sums of the first map
    float *first;
    size_t map_words, map_texels; // words of a map's sums, texels of its first depths
    Queue queue;
    Places ends[MAX_LIGHTS][2]; // [map][turn]: the last two points of each strand
    int turn;
} Brush;

SIMD_INLINE void empty_queue(Queue *queue, uint32_t *sums)
{
    for (int n = 0; n < queue->count; ++n) sums[queue->place[n]] += queue->part[n];
    queue->count = 0;
}

SIMD_INLINE void queue_points(Brush *brush, const int place[W], const uint32_t part[W])
{
    Queue *queue = &brush->queue;
    memcpy(queue->place + queue->count, place, W * sizeof *place);
    memcpy(queue->part + queue->count, part, W * sizeof *part);
    queue->count += W;
    if (queue->count == QUEUE) empty_queue(queue, brush->sums);
}

SIMD_INLINE void add_points(Brush *brush, int map, const Points *points)
{
    const ShadowMap *shadow = brush->splat->shadow;
    int side = shadow->side, wide = shadow->wide, first = map * (int)brush->map_words;
    const float *depths = brush->splat->depths + (size_t)map * (size_t)side * (size_t)side;
    float edge = (float)side - 0.5f;
    for (int turn = 0; turn < points->most; ++turn) {
        int place[W];
        uint32_t part[W];
        for (int k = 0; k < W; ++k) {
            Spot spot = find_spot(points, k, turn, edge);
            int layer = (int)layer_of(spot.z - depths[spot.row * side + spot.column]);
            place[k] = first + (spot.row * LAYERS + layer) * wide + spot.column;
            part[k] = spot.inside ? points->part[k] : 0;
        }
        queue_points(brush, place, part);
    }
}

SIMD_INLINE void keep_firsts(const Brush *brush, int map, const Points *points)
{
    int side = brush->splat->shadow->coarse;
    float edge = (float)side - 0.5f, *first = brush->first + (size_t)map * brush->map_texels;
    for (int turn = 0; turn < points->most; ++turn) {
        int place[W];
        float depth[W];
        for (int k = 0; k < W; ++k) {
            Spot spot = find_spot(points, k, turn, edge);
            place[k] = spot.row * side + spot.column;
            depth[k] = spot.inside ? simd_max(spot.z, 0) : 1;
        }
        for (int k = 0; k < W; ++k) first[place[k]] = simd_min(depth[k], first[place[k]]);
    }
}

// Draws a wide ribbon with the width of its segment at the middle. Each lane is a point of its
// grid.
SIMD_INLINE void lay_wide(Brush *brush, int map, const Points *p, int k, float opacity,
                          float weight, bool deep)
{
    const ShadowSplat *splat = brush->splat;
    const ShadowMap *shadow = splat->shadow;
    int side = deep ? shadow->side : shadow->coarse, wide = shadow->wide,
        base = map * (int)brush->map_words;
    const float *depths = splat->depths + (size_t)map * (size_t)side * (size_t)side;
    float *first = brush->first + (size_t)map * brush->map_texels;
    float width = p->width[k], along = p->along[k], edge = (float)side - 0.5f,
          across = simd_min(simd_ceil(width * dense_wide(splat)), floorf(MOST / along)),
          size = along * sqrtf(p->step_u[k] * p->step_u[k] + p->step_v[k] * p->step_v[k]),
          beside = width / (simd_max(size, 1e-9f) * across) * along;
    float u = p->u[k], v = p->v[k], z = p->z[k], step_u = p->step_u[k], step_v = p->step_v[k],
          step_z = p->step_z[k], side_u = -step_v * beside, side_v = step_u * beside;
    float inverse = 1 / across, middle = 0.5f * (across - 1);
    uint32_t part = caster_part(fibre_depth(opacity, width), width, size,
                                splat->params[map].unit * weight, across * along);
    int count = (int)along * (int)across;
    for (int n = 0; n < count; n += W) {
        int place[W];
        uint32_t parts[W];
        float depth[W];
        for (int i = 0; i < W; ++i) {
            // The half keeps rounding from moving a row's first point to the row before.
            float turn = (float)(int)(((float)(n + i) + 0.5f) * inverse),
                  column = (float)(n + i) - turn * across - middle,
                  at_u = u + turn * step_u + column * side_u,
                  at_v = v + turn * step_v + column * side_v, at_z = z + turn * step_z,
                  x = simd_min(simd_max(at_u, 0), edge), y = simd_min(simd_max(at_v, 0), edge);
            bool inside = (at_u == x) & (at_v == y) & (n + i < count);
            int row = (int)y, texel = row * side + (int)x;
            if (deep) {
                int layer = (int)layer_of(at_z - depths[texel]);
                place[i] = base + (row * LAYERS + layer) * wide + (int)x;
                parts[i] = inside ? part : 0;
            } else {
                place[i] = texel;
                depth[i] = inside ? simd_max(at_z, 0) : 1;
            }
        }
        if (deep)
            queue_points(brush, place, parts);
        else
            for (int i = 0; i < W; ++i) first[place[i]] = simd_min(depth[i], first[place[i]]);
    }
}

// --- Strands.

// Draws the segments that end at point j of each of a tile's strands to all maps.
SIMD_INLINE void lay_next(Brush *brush, const Tile *tile, float weight, int j, const float x[3][W],
                          bool deep)
{
    const ShadowSplat *splat = brush->splat;
    int turn = brush->turn ^= 1;
    Points points;
    float radius[W];
    find_radii(tile, j, radius);
    for (int map = 0; map < splat->maps; ++map) {
        Places *here = &brush->ends[map][turn];
        project_points(&splat->params[map], x, here);
        memcpy(here->radius, radius, sizeof radius);
        if (j == 0) continue;
        lay_points(splat, map, tile, weight, &brush->ends[map][turn ^ 1], here, &points);
        if (deep)
            add_points(brush, map, &points);
        else
            keep_firsts(brush, map, &points);
        for (int k = 0; points.wide && k < tile->strands; ++k)
            if (points.width[k] > CASTER_WIDE)
                lay_wide(brush, map, &points, k, tile->opacity[k], weight, deep);
    }
}

SIMD_INLINE void lay_tile(Brush *brush, const Tile *tile, float weight, bool deep)
{
    const MaterialParams *material = &tile->caster->material;
    int parts = (int)material->smooth_parts, segments = (int)material->vertex_count - 1,
        last = segments * parts;
    float x[3][W];
    CurveSegment segment;
    for (int j = 0; j <= last; ++j) {
        int at = j / parts < segments ? j / parts : segments - 1, k = j - at * parts;
        if (parts > 1) {
            if (k == 0) open_segment(tile, at, &segment);
            find_on_segment(&segment, material->smooth_curve != 0, (float)k / (float)parts, x);
        } else {
            const float(*from)[4] = tile->caster->position + tile_particle(tile, j);
            for (int c = 0; c < 3; ++c)
                for (int i = 0; i < W; ++i) x[c][i] = from[i][c];
        }
        lay_next(brush, tile, weight, j, (const float(*)[W])x, deep);
    }
}

SIMD_INLINE void lay_hair(const ShadowSplat *splat, int part, bool deep)
{
    const ShadowMap *shadow = splat->shadow;
    size_t words = (size_t)LAYERS * (size_t)shadow->side * (size_t)shadow->wide,
           texels = (size_t)shadow->coarse * (size_t)shadow->coarse,
           first = (size_t)part * (size_t)shadow->at_once, maps = (size_t)splat->maps;
    Brush brush;
    brush.splat = splat;
    brush.map_words = words, brush.map_texels = texels;
    brush.sums = deep ? shadow->sums + first * words : NULL;
    brush.first = shadow->first + first * texels;
    brush.queue.count = brush.turn = 0;
    if (deep) memset(brush.sums, 0, maps * words * sizeof *brush.sums);
    for (size_t i = 0; !deep && i < maps * texels; ++i) brush.first[i] = 1;
    for (uint32_t c = 0; c < splat->casters.count; ++c) {
        const MappedCaster *caster = &splat->casters.list[c];
        float weight = caster->weight > 0 ? caster->weight : 1;
        int range[2];
        find_range(caster, part, shadow->drawers, range);
        for (int t = range[0]; t < range[1]; ++t) {
            Tile tile = open_tile(caster, t);
            lay_tile(&brush, &tile, weight, deep);
        }
    }
    if (deep) empty_queue(&brush.queue, brush.sums);
}

SIMD_INLINE void splat(const ShadowSplat *splat, int part)
{
    if (splat->depths)
        lay_hair(splat, part, true);
    else
        lay_hair(splat, part, false);
}

SIMD_STAGE(splat, ShadowSplat)

void shadow_splat_draw(ShadowSplat *all)
{
    run_splat(all, all->shadow->drawers);
}
