// SPDX-License-Identifier: MIT
#include "draw/cpu_shadow.h"

#include "draw/cpu_shadow_maps.h"
#include "draw/cpu_tile.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

// As in shadow_splat.comp.
static const float MOST_ALONG = 512, MOST = 7500, LEAST_LEFT = 1e-3f, WIDE = 1.5f;

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
    uint32_t part[W]; // of the optical depth
    int count[W];     // of thin ribbons
    int most;         // the largest
    bool wide;        // a ribbon has points beside each other, too
} Points;

typedef struct Cast {
    CpuShadow *shadow;
    const CastParams *params;
    CpuCasters casters;
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

Result cpu_shadow_create(CpuShadow *shadow, int side, bool deep, Error *error)
{
    size_t texels = (size_t)side * (size_t)side,
           parts = count_parts((deep ? LAYERS : 1) * texels * sizeof *shadow->sums),
           coarse = (size_t)(deep ? side / SHADOW_COARSE : side);
    *shadow = (CpuShadow){.side = side, .coarse = (int)coarse, .deep = deep, .parts = (int)parts};
    shadow->first = malloc(parts * coarse * coarse * sizeof *shadow->first);
    if (deep) {
        shadow->least = malloc(2 * (coarse + 2) * (coarse + 2) * sizeof *shadow->least);
        shadow->depths = malloc(texels * sizeof *shadow->depths);
        shadow->sums = malloc(parts * LAYERS * texels * sizeof *shadow->sums);
        shadow->rows = malloc(parts * CPU_SHADOW_LINES * ((size_t)side + 2) * sizeof *shadow->rows);
    }
    if (shadow->first &&
        (!deep || (shadow->least && shadow->depths && shadow->sums && shadow->rows)))
        return RESULT_OK;
    cpu_shadow_destroy(shadow);
    return error_set(error, RESULT_FAILED, "no memory for shadow maps of %d texels", side);
}

void cpu_shadow_destroy(CpuShadow *shadow)
{
    free(shadow->first);
    free(shadow->least);
    free(shadow->depths);
    free(shadow->sums);
    free(shadow->rows);
    *shadow = (CpuShadow){0};
}

// --- The box.

// Of what is within reach only: other positions are broken.
SIMD_INLINE void widen_box(const Cast *cast, const Tile *tile, int j, float box[6][W])
{
    const CastParams *params = cast->params;
    const float(*x)[4] = tile->caster->position + tile->at + (size_t)j * W;
    float limit = params->limit, reach = params->reach;
    Places p;
    find_places(params, tile, j, &p);
    float place[3][W];
    for (int k = 0; k < W; ++k) {
        bool sound = (k < tile->strands) & (fabsf(x[k][0]) < limit) & (fabsf(x[k][1]) < limit) &
                     (fabsf(x[k][2]) < limit) & (fabsf(p.u[k]) < reach) & (fabsf(p.v[k]) < reach);
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
        const CpuCaster *caster = &cast->casters.list[c];
        find_range(caster, part, cast->shadow->parts, range);
        for (int t = range[0]; t < range[1]; ++t) {
            Tile tile = open_tile(caster, t);
            for (int j = 0; j < (int)caster->material.vertex_count; ++j)
                widen_box(cast, &tile, j, box);
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

// -ln x for 1e-3 <= x <= 1: ln(2^e m) = e ln 2 + 2 artanh((m - 1) / (m + 1)), with m within
// sqrt(1/2) .. sqrt(2) by the series to the ninth power (1e-9 off).
SIMD_INLINE float minus_log(float x)
{
    union {
        float value;
        int bits;
    } mantissa = {.value = x};
    int exponent = (mantissa.bits - 0x3f3504f3) >> 23;
    mantissa.bits -= exponent * (1 << 23);
    float t = (mantissa.value - 1) / (mantissa.value + 1), s = t * t;
    float series = 1 + s * (1.f / 3 + s * (0.2f + s * (1.f / 7 + s / 9)));
    return -((float)exponent * 0.693147181f + 2 * t * series);
}

// The optical depth of a segment, in the steps of sums, that each of its points has.
SIMD_INLINE uint32_t find_part(float opacity, float width, float size, float unit, float points)
{
    float covered = simd_min(width, 1);
    float depth = minus_log(simd_max(1 - opacity * covered, LEAST_LEFT)) /
                  simd_max(covered, 1e-9f) * width * size;
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

// Depths are 0 .. 1, what is not a number 0. One layer is LAYERS sqrt(behind).
SIMD_INLINE int layer_of(float behind)
{
    return (int)simd_min((float)LAYERS * sqrtf(simd_max(behind, 0)), (float)LAYERS - 1e-3f);
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

SIMD_INLINE void add_points(const Cast *cast, const Points *points, uint32_t *sums)
{
    const float *depths = cast->shadow->depths;
    int side = cast->shadow->side;
    float edge = (float)side - 0.5f;
    for (int turn = 0; turn < points->most; ++turn) {
        int place[W];
        uint32_t part[W];
        for (int k = 0; k < W; ++k) {
            Spot spot = find_spot(points, k, turn, edge);
            int layer = layer_of(spot.z - depths[spot.row * side + spot.column]);
            place[k] = (spot.row * LAYERS + layer) * side + spot.column;
            part[k] = spot.inside ? points->part[k] : 0;
        }
        for (int k = 0; k < W; ++k) sums[place[k]] += part[k];
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
    const CpuShadow *shadow = cast->shadow;
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
            sums[(row * LAYERS + layer_of(z - shadow->depths[texel])) * side + (int)u] += part;
        else
            first[texel] = simd_min(simd_max(z, 0), first[texel]);
    }
}

SIMD_INLINE void lay_tile(const Cast *cast, const Tile *tile, bool deep, uint32_t *sums,
                          float *first)
{
    Places ends[2];
    Points points;
    find_places(cast->params, tile, 0, &ends[0]);
    for (int j = 1; j < (int)tile->caster->material.vertex_count; ++j) {
        find_places(cast->params, tile, j, &ends[j % 2]);
        lay_points(cast, tile, &ends[(j + 1) % 2], &ends[j % 2], &points);
        if (deep)
            add_points(cast, &points, sums);
        else
            keep_firsts(cast, &points, first);
        for (int k = 0; points.wide && k < tile->strands; ++k)
            if (points.width[k] > WIDE) lay_wide(cast, tile, &points, k, sums, first);
    }
}

SIMD_INLINE void lay_hair(const Cast *cast, int part, bool deep)
{
    const CpuShadow *shadow = cast->shadow;
    size_t texels = (size_t)shadow->side * (size_t)shadow->side,
           coarse = (size_t)shadow->coarse * (size_t)shadow->coarse;
    uint32_t *sums = deep ? shadow->sums + (size_t)part * LAYERS * texels : NULL;
    float *first = shadow->first + (size_t)part * coarse;
    int range[2];
    if (deep) memset(sums, 0, LAYERS * texels * sizeof *sums);
    for (size_t i = 0; !deep && i < coarse; ++i) first[i] = 1;
    for (uint32_t c = 0; c < cast->casters.count; ++c) {
        const CpuCaster *caster = &cast->casters.list[c];
        find_range(caster, part, cast->shadow->parts, range);
        for (int t = range[0]; t < range[1]; ++t) {
            Tile tile = open_tile(caster, t);
            lay_tile(cast, &tile, deep, sums, first);
        }
    }
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

bool cpu_shadow_find_box(const CpuShadow *shadow, const CastParams *params, CpuCasters casters,
                         double box[6])
{
    float boxes[PARALLEL_MOST][6];
    CpuShadow drawn = *shadow;
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
static void find_firsts(CpuShadow *shadow, const CastParams *params, CpuCasters casters, int coarse,
                        Density density)
{
    CastParams wide = *params;
    wide.texels /= (float)coarse;
    for (int k = 0; k < 2; ++k)
        for (int i = 0; i < 4; ++i) wide.from_world[k][i] /= (float)coarse;
    Cast cast = {.shadow = shadow, .params = &wide, .casters = casters, .density = density};
    run_splat(&cast, shadow->parts);
    cpu_shadow_merge_firsts(shadow);
}

void cpu_shadow_draw_deep(CpuShadow *shadow, const CastParams *params, CpuCasters casters,
                          float *depths, uint32_t *layers)
{
    Cast cast = {.shadow = shadow,
                 .params = params,
                 .casters = casters,
                 .density = DEEP_POINTS,
                 .deep = true};
    find_firsts(shadow, params, casters, SHADOW_COARSE, COARSE_POINTS);
    cpu_shadow_spread(shadow);
    run_splat(&cast, shadow->parts);
    cpu_shadow_finish(shadow, params->unit, layers);
    memcpy(depths, shadow->depths, (size_t)shadow->side * (size_t)shadow->side * sizeof *depths);
}

void cpu_shadow_draw_firsts(CpuShadow *shadow, const CastParams *params, CpuCasters casters,
                            uint32_t *firsts)
{
    size_t texels = (size_t)shadow->side * (size_t)shadow->side;
    find_firsts(shadow, params, casters, 1, FIRST_POINTS);
    for (size_t i = 0; i < texels; ++i)
        firsts[i] = (uint32_t)((double)shadow->first[i] * SHADOW_DEPTHS);
}
