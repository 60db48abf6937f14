// SPDX-License-Identifier: MIT
#include "lanes/shadow_map.h"

#include "lanes/shadow_tile.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

// Lines of each thread's part of `rows`: three rows of all layers, and two more.
enum { LINES = 3 * LAYERS + 2 };

// As in shadow_splat.comp.
static const float MOST_ALONG = 512, MOST = 7500, WIDE = 1.5f;

// How close points lie, in texels of the map that they go to (see shadow_splat.comp).
typedef struct Density {
    float thin, wide, slack;
} Density;
static const Density DEEP_POINTS = {0.5f, 2, 0}, COARSE_POINTS = {0.5f, 1.42f, 0.5f},
                     FIRST_POINTS = {1, 1.42f, 0};

// A row of segments as points: `count` of them from (u, v, z) on.
typedef struct Points {
    float u[W], v[W], z[W], step_u[W], step_v[W], step_z[W];
    float along[W], width[W];
    uint32_t part[W]; // see find_part
    int count[W];     // of thin ribbons
    int most;         // the largest
    bool wide;        // a ribbon has points beside each other, too
} Points;

typedef struct Cast {
    ShadowMap *shadow;
    const CastParams *params;
    MappedCasters casters;
    Density density;
    bool deep;
    float (*box)[6]; // [parts]
} Cast;

// As many threads as there are, but for the memory of their maps.
static size_t count_parts(size_t map_bytes)
{
    const size_t most_bytes = (size_t)256 << 20;
    size_t parts = (size_t)parallel_threads(), most = most_bytes / map_bytes;
    return parts <= most ? parts : most ? most : 1;
}

Result shadow_map_create(ShadowMap *shadow, int side, bool deep, Error *error)
{
    size_t texels = (size_t)side * (size_t)side, wide = ((size_t)side + 47) / 64 * 64 + 16,
           row = (size_t)side * wide,
           parts = count_parts(deep ? LAYERS * row * sizeof *shadow->sums
                                    : texels * sizeof *shadow->first),
           coarse = (size_t)(deep ? side / SHADOW_COARSE : side);
    *shadow = (ShadowMap){
        .side = side, .wide = (int)wide, .coarse = (int)coarse, .deep = deep, .parts = (int)parts};
    shadow->first = malloc(parts * coarse * coarse * sizeof *shadow->first);
    if (deep) {
        shadow->least = malloc(2 * (coarse + 2) * (coarse + 2) * sizeof *shadow->least);
        shadow->depths = malloc(texels * sizeof *shadow->depths);
        shadow->sums = malloc(parts * LAYERS * row * sizeof *shadow->sums);
        shadow->rows = malloc(parts * LINES * ((size_t)side + 2) * sizeof *shadow->rows);
    }
    if (shadow->first &&
        (!deep || (shadow->least && shadow->depths && shadow->sums && shadow->rows)))
        return RESULT_OK;
    shadow_map_destroy(shadow);
    return error_set(error, RESULT_FAILED, "no memory for shadow maps of %d texels", side);
}

void shadow_map_destroy(ShadowMap *shadow)
{
    free(shadow->first);
    free(shadow->least);
    free(shadow->depths);
    free(shadow->sums);
    free(shadow->rows);
    *shadow = (ShadowMap){0};
}

// --- The box.

// Of what is within reach only: other positions are broken.
SIMD_INLINE void widen_box(const Cast *cast, const Tile *tile, int j, float box[6][W])
{
    const CastParams *params = cast->params;
    float own[3][W], limit = params->limit, reach = params->reach;
    const float(*x)[W] = find_points(tile, j, own);
    Places p;
    project_points(params, x, &p);
    float place[3][W];
    for (int k = 0; k < W; ++k) {
        bool sound = (k < tile->strands) & (fabsf(x[0][k]) < limit) & (fabsf(x[1][k]) < limit) &
                     (fabsf(x[2][k]) < limit) & (fabsf(p.u[k]) < reach) & (fabsf(p.v[k]) < reach);
        place[0][k] = sound ? p.u[k] : NAN; // which no comparison takes
        place[1][k] = sound ? p.v[k] : NAN;
        place[2][k] = sound ? p.z[k] : NAN;
    }
    for (int i = 0; i < 3; ++i)
        for (int k = 0; k < W; ++k) {
            box[i][k] = simd_min(place[i][k], box[i][k]);
            box[i + 3][k] = simd_max(place[i][k], box[i + 3][k]);
        }
}

SIMD_INLINE void find_box(const Cast *cast, int part)
{
    float box[6][W];
    int range[2];
    for (int k = 0; k < W; ++k)
        for (int i = 0; i < 6; ++i) box[i][k] = i < 3 ? INFINITY : -INFINITY;
    for (uint32_t c = 0; c < cast->casters.count; ++c) {
        MappedCaster plain = cast->casters.list[c], *caster = &plain;
        plain.order = NULL; // each tile is read once
        find_range(caster, part, cast->shadow->parts, range);
        for (int t = range[0]; t < range[1]; ++t) {
            Tile tile = open_tile(caster, t);
            for (int j = 0; j < mapped_caster_points(caster); ++j) widen_box(cast, &tile, j, box);
        }
    }
    float *whole = cast->box[part];
    for (int i = 0; i < 6; ++i) whole[i] = box[i][0];
    for (int k = 1; k < W; ++k)
        for (int i = 0; i < 3; ++i) {
            whole[i] = simd_min(box[i][k], whole[i]);
            whole[i + 3] = simd_max(box[i + 3][k], whole[i + 3]);
        }
}

// --- Points.

// What each point of a segment adds to a texel, in the steps of sums: the segment's area is
// `width` times `size` texels.
SIMD_INLINE uint32_t find_part(float opacity, float width, float size, float unit, float points)
{
    float depth = fibre_depth(opacity, width) * width * size;
    return (uint32_t)(int)(simd_min(simd_max(depth * unit, 0) / points, 2e9f) + 0.5f);
}

// How a ribbon is laid down: points along it, and for wide ones beside each other.
SIMD_INLINE void lay_points(const Cast *cast, const Tile *tile, const Places *a, const Places *b,
                            Points *points)
{
    float texels = cast->params->texels, unit = cast->params->unit;
    Density density = cast->density;
    int most = 0;
    float widest = 0;
    for (int k = 0; k < W; ++k) {
        float u = b->u[k] - a->u[k], v = b->v[k] - a->v[k], z = b->z[k] - a->z[k];
        float size = sqrtf(u * u + v * v),
              width = 2 * texels * (a->radius[k] + b->radius[k]) / (a->w[k] + b->w[k]);
        float dense = simd_min(size * (width > WIDE ? density.wide : density.thin), MOST_ALONG);
        float along = simd_max(simd_ceil(dense - density.slack), 1), inverse = 1 / along;
        points->step_u[k] = u * inverse;
        points->step_v[k] = v * inverse;
        points->step_z[k] = z * inverse;
        points->u[k] = a->u[k] + 0.5f * points->step_u[k];
        points->v[k] = a->v[k] + 0.5f * points->step_v[k];
        points->z[k] = a->z[k] + 0.5f * points->step_z[k];
        points->along[k] = along;
        points->width[k] = width;
        points->part[k] = find_part(tile->opacity[k], width, size, unit, along);
        bool thin = (k < tile->strands) & (width <= WIDE);
        points->count[k] = thin ? (int)along : 0;
    }
    for (int k = 0; k < W; ++k) most = points->count[k] > most ? points->count[k] : most;
    for (int k = 0; k < W; ++k) widest = simd_max(points->width[k], widest);
    points->most = most;
    points->wide = widest > WIDE;
}

// Where a turn's point of strand k lies: at the edge with nothing to add if beside the map.
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

// Points on their way into the sums: laid down many at a time, since additions to places that are
// known do not wait for each other's.
enum { QUEUE = 2048 };
typedef struct Queue {
    int count;
    int place[QUEUE];
    uint32_t part[QUEUE];
} Queue;

SIMD_INLINE void empty_queue(Queue *queue, uint32_t *sums)
{
    for (int n = 0; n < queue->count; ++n) sums[queue->place[n]] += queue->part[n];
    queue->count = 0;
}

SIMD_INLINE void add_points(const Cast *cast, const Points *points, Queue *queue, uint32_t *sums)
{
    const float *depths = cast->shadow->depths;
    int side = cast->shadow->side, wide = cast->shadow->wide;
    float edge = (float)side - 0.5f;
    for (int turn = 0; turn < points->most; ++turn) {
        int place[W];
        uint32_t part[W];
        for (int k = 0; k < W; ++k) {
            Spot spot = find_spot(points, k, turn, edge);
            int layer = (int)layer_of(spot.z - depths[spot.row * side + spot.column]);
            place[k] = (spot.row * LAYERS + layer) * wide + spot.column;
            part[k] = spot.inside ? points->part[k] : 0;
        }
        memcpy(queue->place + queue->count, place, sizeof place);
        memcpy(queue->part + queue->count, part, sizeof part);
        queue->count += W;
        if (queue->count == QUEUE) empty_queue(queue, sums);
    }
}

SIMD_INLINE void keep_firsts(const Cast *cast, const Points *points, float *first)
{
    int side = cast->shadow->coarse;
    float edge = (float)side - 0.5f;
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

// A wide ribbon, as wide as its segment is at the middle.
static void lay_wide(const Cast *cast, const Tile *tile, const Points *p, int k, uint32_t *sums,
                     float *first)
{
    const ShadowMap *shadow = cast->shadow;
    int side = cast->deep ? shadow->side : shadow->coarse, along = (int)p->along[k];
    float across =
              simd_min(simd_ceil(p->width[k] * cast->density.wide), floorf(MOST / p->along[k])),
          size = p->along[k] * sqrtf(p->step_u[k] * p->step_u[k] + p->step_v[k] * p->step_v[k]),
          beside = p->width[k] / (simd_max(size, 1e-9f) * across) * p->along[k];
    float step_u = -p->step_v[k] * beside, step_v = p->step_u[k] * beside;
    uint32_t part =
        find_part(tile->opacity[k], p->width[k], size, cast->params->unit, across * p->along[k]);
    for (int i = 0; i < along * (int)across; ++i) {
        float turn = (float)(i / (int)across),
              column = (float)(i % (int)across) - 0.5f * (across - 1);
        float u = p->u[k] + turn * p->step_u[k] + column * step_u,
              v = p->v[k] + turn * p->step_v[k] + column * step_v,
              z = p->z[k] + turn * p->step_z[k];
        if (!(u >= 0 && v >= 0 && u <= (float)side - 0.5f && v <= (float)side - 0.5f)) continue;
        int row = (int)v, texel = row * side + (int)u;
        if (cast->deep)
            sums[(row * LAYERS + (int)layer_of(z - shadow->depths[texel])) * shadow->wide +
                 (int)u] += part;
        else
            first[texel] = simd_min(simd_max(z, 0), first[texel]);
    }
}

SIMD_INLINE void lay_tile(const Cast *cast, const Tile *tile, bool deep, Queue *queue,
                          uint32_t *sums, float *first)
{
    Places ends[2];
    Points points;
    find_places(cast->params, tile, 0, &ends[0]);
    for (int j = 1; j < mapped_caster_points(tile->caster); ++j) {
        find_places(cast->params, tile, j, &ends[j % 2]);
        lay_points(cast, tile, &ends[(j + 1) % 2], &ends[j % 2], &points);
        if (deep)
            add_points(cast, &points, queue, sums);
        else
            keep_firsts(cast, &points, first);
        for (int k = 0; points.wide && k < tile->strands; ++k)
            if (points.width[k] > WIDE) lay_wide(cast, tile, &points, k, sums, first);
    }
}

SIMD_INLINE void lay_hair(const Cast *cast, int part, bool deep)
{
    const ShadowMap *shadow = cast->shadow;
    size_t words = LAYERS * (size_t)shadow->side * (size_t)shadow->wide,
           coarse = (size_t)shadow->coarse * (size_t)shadow->coarse;
    uint32_t *sums = deep ? shadow->sums + (size_t)part * words : NULL;
    float *first = shadow->first + (size_t)part * coarse;
    Queue queue;
    int range[2];
    queue.count = 0;
    if (deep) memset(sums, 0, words * sizeof *sums);
    for (size_t i = 0; !deep && i < coarse; ++i) first[i] = 1;
    for (uint32_t c = 0; c < cast->casters.count; ++c) {
        const MappedCaster *caster = &cast->casters.list[c];
        find_range(caster, part, cast->shadow->parts, range);
        for (int t = range[0]; t < range[1]; ++t) {
            Tile tile = open_tile(caster, t);
            lay_tile(cast, &tile, deep, &queue, sums, first);
        }
    }
    if (deep) empty_queue(&queue, sums);
}

SIMD_INLINE void splat(const Cast *cast, int part)
{
    if (cast->deep)
        lay_hair(cast, part, true);
    else
        lay_hair(cast, part, false);
}

SIMD_STAGE(find_box, Cast)
SIMD_STAGE(splat, Cast)

// --- From the points that threads have laid down in maps of their own to one map.

typedef struct Finish {
    const ShadowMap *shadow;
    float unit;
    uint32_t *layers; // [LAYERS][side][side]
} Finish;

// A row's sums of all threads, smoothed with their neighbours (1 2 1); beyond the edges stand the
// outermost again.
SIMD_INLINE void gather_row(const ShadowMap *shadow, int row, float *line, float *smooth)
{
    int side = shadow->side;
    row = row < 0 ? 0 : row >= side ? side - 1 : row;
    size_t wide = (size_t)shadow->wide, map = (size_t)side * LAYERS * wide;
    for (size_t layer = 0; layer < LAYERS; ++layer, smooth += side) {
        const uint32_t *sums = shadow->sums + ((size_t)row * LAYERS + layer) * wide;
        for (int x = 0; x < side; ++x) line[x + 1] = (float)(int)sums[x];
        for (int part = 1; part < shadow->parts; ++part) {
            sums += map;
            for (int x = 0; x < side; ++x) line[x + 1] += (float)(int)sums[x];
        }
        line[0] = line[1];
        line[side + 1] = line[side];
        for (int x = 0; x < side; ++x) smooth[x] = line[x] + 2 * line[x + 1] + line[x + 2];
    }
}

// Smooths the other way and adds up, layer by layer: three rows of all layers to one.
SIMD_INLINE void finish_row(const Finish *maps, int row, float *const rows[3], float *before)
{
    size_t side = (size_t)maps->shadow->side;
    float scale = 1 / (16 * maps->unit);
    for (size_t x = 0; x < side; ++x) before[x] = 0;
    for (size_t layer = 0; layer < LAYERS; ++layer) {
        const float *a = rows[0] + layer * side, *b = rows[1] + layer * side,
                    *c = rows[2] + layer * side;
        uint32_t *out = maps->layers + (layer * side + (size_t)row) * side;
        for (size_t x = 0; x < side; ++x) {
            float own = scale * (a[x] + 2 * b[x] + c[x]);
            out[x] = pack_layer(before[x], own);
            before[x] += own;
        }
    }
}

SIMD_INLINE void finish(const Finish *maps, int part)
{
    const ShadowMap *shadow = maps->shadow;
    size_t side = (size_t)shadow->side;
    int row = shadow->side * part / shadow->parts, end = shadow->side * (part + 1) / shadow->parts;
    float *line = shadow->rows + (size_t)part * LINES * (side + 2), *before = line + side + 2,
          *rows[3];
    for (int i = 0; i < 3; ++i) rows[i] = before + side + 2 + (size_t)i * LAYERS * side;
    gather_row(shadow, row - 1, line, rows[0]);
    gather_row(shadow, row, line, rows[1]);
    for (; row < end; ++row) {
        gather_row(shadow, row + 1, line, rows[2]);
        finish_row(maps, row, rows, before);
        float *above = rows[0];
        rows[0] = rows[1], rows[1] = rows[2], rows[2] = above;
    }
}

SIMD_STAGE(finish, Finish)

// The least of all threads' first depths, in those of the first.
static void merge_firsts(ShadowMap *shadow)
{
    size_t texels = (size_t)shadow->coarse * (size_t)shadow->coarse;
    for (size_t part = 1; part < (size_t)shadow->parts; ++part)
        for (size_t i = 0; i < texels; ++i)
            shadow->first[i] = simd_min(shadow->first[part * texels + i], shadow->first[i]);
}

static int within(int i, int count)
{
    return i < 0 ? 0 : i >= count ? count - 1 : i;
}

// Of `count` values the least of three neighbours, from the place before the first to the one
// behind the last; strides are those of in and out.
static void find_least(const float *in, float *out, int count, size_t stride)
{
    for (int i = -1; i <= count; ++i) {
        float here = in[(size_t)within(i, count) * stride];
        here = simd_min(in[(size_t)within(i - 1, count) * stride], here);
        out[(size_t)(i + 1) * stride] = simd_min(in[(size_t)within(i + 1, count) * stride], here);
    }
}

// Merged first depths to `depths`, as shadow_spread.comp: the least of 3 x 3 coarse texels, then
// linear between them.
static void spread(ShadowMap *shadow)
{
    enum { C = SHADOW_COARSE };
    int side = shadow->side, coarse = shadow->coarse, wide = coarse + 2;
    float *least = shadow->least, *line = least + wide * wide;
    for (int x = 0; x < coarse; ++x) // down each column, at its place in rows of `wide`
        for (int y = 0; y < coarse; ++y) line[y * wide + x] = shadow->first[y * coarse + x];
    for (int x = 0; x < coarse; ++x) find_least(line + x, least + x, coarse, (size_t)wide);
    for (int y = 0; y < wide; ++y) find_least(least + y * wide, line + y * wide, coarse, 1);
    for (int y = 0; y < side; ++y) {
        const float *above = line + (y + C / 2) / C * wide, *below = above + wide;
        float share = ((float)((y + C / 2) % C) + 0.5f) / C, *out = shadow->depths + y * side;
        for (int x = 0; x < side; ++x) {
            int i = (x + C / 2) / C;
            float along = ((float)((x + C / 2) % C) + 0.5f) / C;
            float left = above[i] + share * (below[i] - above[i]),
                  right = above[i + 1] + share * (below[i + 1] - above[i + 1]);
            out[x] = left + along * (right - left);
        }
    }
}

// --- Whole maps.

bool shadow_map_find_box(const ShadowMap *shadow, const CastParams *params, MappedCasters casters,
                         double box[6])
{
    float boxes[PARALLEL_MOST][6];
    ShadowMap drawn = *shadow;
    Cast cast = {.shadow = &drawn, .params = params, .casters = casters, .box = boxes};
    run_find_box(&cast, shadow->parts);
    for (int i = 0; i < 6; ++i) {
        box[i] = (double)boxes[0][i];
        for (int part = 1; part < shadow->parts; ++part)
            box[i] =
                i < 3 ? fmin(box[i], (double)boxes[part][i]) : fmax(box[i], (double)boxes[part][i]);
    }
    return box[0] <= box[3];
}

// `coarse`: how many of the map's texels one of the first depths is wide.
static void find_firsts(ShadowMap *shadow, const CastParams *params, MappedCasters casters,
                        int coarse, Density density)
{
    CastParams wide = *params;
    wide.texels /= (float)coarse;
    for (int k = 0; k < 2; ++k)
        for (int i = 0; i < 4; ++i) wide.from_world[k][i] /= (float)coarse;
    Cast cast = {.shadow = shadow, .params = &wide, .casters = casters, .density = density};
    run_splat(&cast, shadow->parts);
    merge_firsts(shadow);
}

void shadow_map_draw_deep(ShadowMap *shadow, const CastParams *params, MappedCasters casters,
                          float *depths, uint32_t *layers)
{
    Cast cast = {.shadow = shadow,
                 .params = params,
                 .casters = casters,
                 .density = DEEP_POINTS,
                 .deep = true};
    find_firsts(shadow, params, casters, SHADOW_COARSE, COARSE_POINTS);
    spread(shadow);
    run_splat(&cast, shadow->parts);
    run_finish(&(Finish){shadow, params->unit, layers}, shadow->parts);
    memcpy(depths, shadow->depths, (size_t)shadow->side * (size_t)shadow->side * sizeof *depths);
}

void shadow_map_draw_firsts(ShadowMap *shadow, const CastParams *params, MappedCasters casters,
                            uint32_t *firsts)
{
    size_t texels = (size_t)shadow->side * (size_t)shadow->side;
    find_firsts(shadow, params, casters, 1, FIRST_POINTS);
    for (size_t i = 0; i < texels; ++i)
        firsts[i] = (uint32_t)((double)shadow->first[i] * SHADOW_DEPTHS);
}
