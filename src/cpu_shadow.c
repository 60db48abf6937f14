// SPDX-License-Identifier: MIT
#include "cpu_shadow.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

// Loops over the strands of a tile are innermost and have no branches, so that compilers turn them
// into vector instructions; -ffp-contract=off and no function of libm keep the bits the same
// whatever these are.
enum { W = STRAND_TILE, LAYERS = SHADOW_LAYERS, ROWS_LINES = 3 * LAYERS + 2 };

#define INLINE static inline __attribute__((always_inline))

// As in shadow_splat.comp.
static const float MOST_ALONG = 512, MOST = 7500, LEAST_LEFT = 1e-3f, WIDE = 1.5f;

// How close points lie, in texels of the map that they go to (see shadow_splat.comp).
typedef struct Density {
    float thin, wide, slack;
} Density;
static const Density DEEP_POINTS = {0.5f, 2, 0}, COARSE_POINTS = {0.5f, 1.42f, 0.5f},
                     FIRST_POINTS = {1, 1.42f, 0};

// Where the particles of a tile lie before the light, and their radii (m).
typedef struct Places {
    float u[W], v[W], z[W], w[W], radius[W];
} Places;

// A row of segments as points: `count` of them from (u, v, z) on.
typedef struct Points {
    float u[W], v[W], z[W], step_u[W], step_v[W], step_z[W];
    float along[W], width[W];
    uint32_t part[W]; // of the optical depth
    int count[W];     // of thin ribbons
    int most;         // the largest
    bool wide;        // a ribbon has points beside each other, too
} Points;

// One tile of one caster.
typedef struct Tile {
    const CpuCaster *caster;
    size_t at;   // of its first particle
    int strands; // that are drawn
    float radius[W], opacity[W];
} Tile;

typedef struct Cast {
    CpuShadow *shadow;
    const CastParams *params;
    CpuCasters casters;
    Density density;
    bool deep;
    float (*box)[6];  // [parts]
    uint32_t *layers; // [LAYERS][side][side]
    // Where light is found:
    const uint32_t *found_layers;
    float across, *left, last; // LAYERS - 1e-3: a bound that compilers know makes them jump
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
        shadow->rows = malloc(parts * ROWS_LINES * ((size_t)side + 2) * sizeof *shadow->rows);
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

// --- Lanes. Comparisons that are one instruction; what is not a number becomes the bound.

INLINE float larger(float a, float least)
{
    return a > least ? a : least;
}
INLINE float smaller(float a, float most)
{
    return a < most ? a : most;
}
// The larger of x and 0, without a comparison: one whose outcome tells that of the next becomes a
// jump, and its loop does not become vector instructions.
INLINE float positive(float x)
{
    return 0.5f * (x + fabsf(x));
}
INLINE float ceiling(float x)
{
    float whole = (float)(int)x;
    return whole < x ? whole + 1 : whole;
}

// -ln x for 1e-3 <= x <= 1: ln(2^e m) = e ln 2 + 2 artanh((m - 1) / (m + 1)), with m within
// sqrt(1/2) .. sqrt(2) by the series to the ninth power (1e-9 off).
INLINE float minus_log(float x)
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

INLINE float share_of(const CpuCaster *caster, size_t at)
{
    float share;
    memcpy(&share, &caster->paint[at][2], sizeof share);
    return share;
}

// Particle j of the tile's strands. What lies beside a lamp or behind it goes far away.
INLINE void find_places(const CastParams *params, const Tile *tile, int j, Places *places)
{
    const float(*rows)[4] = (const float(*)[4])params->from_world;
    const CpuCaster *caster = tile->caster;
    const MaterialParams *material = &caster->material;
    size_t at = tile->at + (size_t)j * W;
    const float(*x)[4] = caster->position + at;
    float thinning = (1 - material->tip_ratio) / (float)(material->vertex_count - 1),
          share = 1 - thinning * (float)j;
    for (int k = 0; k < W; ++k) {
        float p = x[k][0], q = x[k][1], r = x[k][2], one = x[k][3];
        float w = rows[3][0] * p + rows[3][1] * q + rows[3][2] * r + rows[3][3] * one,
              inverse = 1 / larger(w, 1e-6f);
        float u = rows[0][0] * p + rows[0][1] * q + rows[0][2] * r + rows[0][3] * one,
              v = rows[1][0] * p + rows[1][1] * q + rows[1][2] * r + rows[1][3] * one;
        places->u[k] = w > 0 ? u * inverse : -1e6f;
        places->v[k] = w > 0 ? v * inverse : -1e6f;
        places->z[k] = rows[2][0] * p + rows[2][1] * q + rows[2][2] * r + rows[2][3] * one;
        places->w[k] = larger(w, 1e-6f);
    }
    for (int k = 0; k < W; ++k) places->radius[k] = larger(tile->radius[k] * share, 1e-9f);
    for (int k = 0; caster->paint && k < W; ++k)
        places->radius[k] = larger(tile->radius[k] * share_of(caster, at + (size_t)k), 1e-9f);
}

static Tile open_tile(const CpuCaster *caster, int number)
{
    const MaterialParams *material = &caster->material;
    int first = number * W, left = (int)material->drawn_strands - first;
    Tile tile = {.caster = caster,
                 .at = (size_t)first * material->vertex_count,
                 .strands = left < W ? left : W};
    for (int k = 0; k < W; ++k) {
        bool last = first + k == (int)material->last_strand;
        tile.radius[k] = material->radius * (last ? material->last_share : 1);
        uint32_t bits = caster->paint ? caster->paint[tile.at + (size_t)k][1] >> 16 : 0xffff;
        tile.opacity[k] = material->shadow_opacity * (float)bits / 65535;
    }
    return tile;
}

// The tiles of a caster that one of `parts` threads works on.
static void find_range(const Cast *cast, const CpuCaster *caster, int part, int range[2])
{
    int64_t tiles = ((int64_t)caster->material.drawn_strands + W - 1) / W,
            parts = cast->shadow->parts;
    range[0] = (int)(tiles * part / parts);
    range[1] = (int)(tiles * (part + 1) / parts);
}

// --- The box.

// Of what is within reach only: other positions are broken.
INLINE void widen_box(const Cast *cast, const Tile *tile, int j, float box[6][W])
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
            box[i][k] = smaller(place[i][k], box[i][k]);
            box[i + 3][k] = larger(place[i][k], box[i + 3][k]);
        }
}

INLINE void find_box(const Cast *cast, int part)
{
    float box[6][W];
    int range[2];
    for (int k = 0; k < W; ++k)
        for (int i = 0; i < 6; ++i) box[i][k] = i < 3 ? INFINITY : -INFINITY;
    for (uint32_t c = 0; c < cast->casters.count; ++c) {
        const CpuCaster *caster = &cast->casters.list[c];
        find_range(cast, caster, part, range);
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
            whole[i] = smaller(box[i][k], whole[i]);
            whole[i + 3] = larger(box[i + 3][k], whole[i + 3]);
        }
}

// --- Points.

// The optical depth of a segment, in the steps of sums, that each of its points has.
INLINE uint32_t find_part(float opacity, float width, float size, float unit, float points)
{
    float covered = smaller(width, 1);
    float depth = minus_log(larger(1 - opacity * covered, LEAST_LEFT)) / larger(covered, 1e-9f) *
                  width * size;
    return (uint32_t)(int)(smaller(larger(depth * unit, 0) / points, 2e9f) + 0.5f);
}

// How a ribbon is laid down: points along it, and for wide ones beside each other.
INLINE void lay_points(const Cast *cast, const Tile *tile, const Places *a, const Places *b,
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
        float dense = smaller(size * (width > WIDE ? density.wide : density.thin), MOST_ALONG);
        float along = larger(ceiling(dense - density.slack), 1), inverse = 1 / along;
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
    for (int k = 0; k < W; ++k) widest = larger(points->width[k], widest);
    points->most = most;
    points->wide = widest > WIDE;
}

// Depths are 0 .. 1, what is not a number 0. One layer is LAYERS sqrt(behind).
INLINE int layer_of(float behind)
{
    return (int)smaller((float)LAYERS * sqrtf(larger(behind, 0)), (float)LAYERS - 1e-3f);
}

INLINE void add_points(const Cast *cast, const Points *points, uint32_t *sums)
{
    const float *depths = cast->shadow->depths;
    int side = cast->shadow->side;
    float edge = (float)side - 0.5f;
    for (int turn = 0; turn < points->most; ++turn) {
        int place[W];
        uint32_t part[W];
        for (int k = 0; k < W; ++k) {
            float u = points->u[k] + (float)turn * points->step_u[k],
                  v = points->v[k] + (float)turn * points->step_v[k],
                  z = points->z[k] + (float)turn * points->step_z[k];
            float x = smaller(larger(u, 0), edge), y = smaller(larger(v, 0), edge);
            bool inside = (u == x) & (v == y) & (turn < points->count[k]);
            int row = (int)y, column = (int)x, layer = layer_of(z - depths[row * side + column]);
            place[k] = (row * LAYERS + layer) * side + column;
            part[k] = inside ? points->part[k] : 0;
        }
        for (int k = 0; k < W; ++k) sums[place[k]] += part[k];
    }
}

INLINE void keep_firsts(const Cast *cast, const Points *points, float *first)
{
    int side = cast->shadow->coarse;
    float edge = (float)side - 0.5f;
    for (int turn = 0; turn < points->most; ++turn) {
        int place[W];
        float depth[W];
        for (int k = 0; k < W; ++k) {
            float u = points->u[k] + (float)turn * points->step_u[k],
                  v = points->v[k] + (float)turn * points->step_v[k],
                  z = points->z[k] + (float)turn * points->step_z[k];
            float x = smaller(larger(u, 0), edge), y = smaller(larger(v, 0), edge);
            bool inside = (u == x) & (v == y) & (turn < points->count[k]);
            place[k] = (int)y * side + (int)x;
            depth[k] = inside ? larger(z, 0) : 1;
        }
        for (int k = 0; k < W; ++k) first[place[k]] = smaller(depth[k], first[place[k]]);
    }
}

// A wide ribbon, as wide as its segment is at the middle.
static void lay_wide(const Cast *cast, const Tile *tile, const Points *p, int k, uint32_t *sums,
                     float *first)
{
    const CpuShadow *shadow = cast->shadow;
    int side = cast->deep ? shadow->side : shadow->coarse, along = (int)p->along[k];
    float across = smaller(ceiling(p->width[k] * cast->density.wide), floorf(MOST / p->along[k])),
          size = p->along[k] * sqrtf(p->step_u[k] * p->step_u[k] + p->step_v[k] * p->step_v[k]),
          beside = p->width[k] / (larger(size, 1e-9f) * across) * p->along[k];
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
            first[texel] = smaller(larger(z, 0), first[texel]);
    }
}

INLINE void lay_tile(const Cast *cast, const Tile *tile, bool deep, uint32_t *sums, float *first)
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

INLINE void lay_hair(const Cast *cast, int part, bool deep)
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
        find_range(cast, caster, part, range);
        for (int t = range[0]; t < range[1]; ++t) {
            Tile tile = open_tile(caster, t);
            lay_tile(cast, &tile, deep, sums, first);
        }
    }
}

// --- From points to maps.

// A row's sums of all threads, smoothed with their neighbours (1 2 1); beyond the edges stand the
// outermost again.
INLINE void gather_row(const CpuShadow *shadow, int row, float *line, float *smooth)
{
    int side = shadow->side;
    row = row < 0 ? 0 : row >= side ? side - 1 : row;
    size_t width = (size_t)side, map = width * LAYERS * width;
    for (size_t layer = 0; layer < LAYERS; ++layer, smooth += side) {
        const uint32_t *sums = shadow->sums + ((size_t)row * LAYERS + layer) * width;
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

// As pack_layer of shadow_layer.glsl.
INLINE uint32_t pack_layer(float before, float own)
{
    const float steps = 4096, most = 65535;
    return (uint32_t)(int)smaller(before * steps + 0.5f, most) |
           (uint32_t)(int)smaller(own * steps + 0.5f, most) << 16;
}

// Smooths the other way and adds up, layer by layer: three rows of all layers to one.
INLINE void finish_row(const Cast *cast, int row, float *const rows[3], float *before)
{
    size_t side = (size_t)cast->shadow->side;
    float scale = 1 / (16 * cast->params->unit);
    for (size_t x = 0; x < side; ++x) before[x] = 0;
    for (size_t layer = 0; layer < LAYERS; ++layer) {
        const float *a = rows[0] + layer * side, *b = rows[1] + layer * side,
                    *c = rows[2] + layer * side;
        uint32_t *out = cast->layers + (layer * side + (size_t)row) * side;
        for (size_t x = 0; x < side; ++x) {
            float own = scale * (a[x] + 2 * b[x] + c[x]);
            out[x] = pack_layer(before[x], own);
            before[x] += own;
        }
    }
}

INLINE void finish(const Cast *cast, int part)
{
    const CpuShadow *shadow = cast->shadow;
    size_t side = (size_t)shadow->side;
    int row = shadow->side * part / shadow->parts, end = shadow->side * (part + 1) / shadow->parts;
    float *line = shadow->rows + (size_t)part * ROWS_LINES * (side + 2), *before = line + side + 2,
          *rows[3];
    for (int i = 0; i < 3; ++i) rows[i] = before + side + 2 + (size_t)i * LAYERS * side;
    gather_row(shadow, row - 1, line, rows[0]);
    gather_row(shadow, row, line, rows[1]);
    for (; row < end; ++row) {
        gather_row(shadow, row + 1, line, rows[2]);
        finish_row(cast, row, rows, before);
        float *above = rows[0];
        rows[0] = rows[1], rows[1] = rows[2], rows[2] = above;
    }
}

static void merge_firsts(CpuShadow *shadow)
{
    size_t texels = (size_t)shadow->coarse * (size_t)shadow->coarse;
    for (size_t part = 1; part < (size_t)shadow->parts; ++part)
        for (size_t i = 0; i < texels; ++i)
            shadow->first[i] = smaller(shadow->first[part * texels + i], shadow->first[i]);
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
        here = smaller(in[(size_t)within(i - 1, count) * stride], here);
        out[(size_t)(i + 1) * stride] = smaller(in[(size_t)within(i + 1, count) * stride], here);
    }
}

// As shadow_spread.comp: the least of 3 x 3 coarse texels, then linear between them.
static void spread(CpuShadow *shadow)
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

// --- Light at particles, as light_through_hair of shadow.glsl finds it.

// 2^x for -60 <= x <= 0: of the fraction -1/2 .. 1/2 the Taylor series to the sixth power (1.2e-7
// off), the rest as exponent bits.
INLINE float exp2_of(float x)
{
    int whole = (int)(x - 0.5f);
    float f = (x - (float)whole) * 0.693147181f;
    float power =
        1 + f * (1 + f * (0.5f + f * (1.f / 6 + f * (1.f / 24 + f * (1.f / 120 + f / 720)))));
    union {
        int bits;
        float value;
    } exponent = {.bits = (whole + 127) * (1 << 23)};
    return power * exponent.value;
}

INLINE float mix4(float a, float b, float c, float d, float u, float v)
{
    float above = a + u * (b - a), below = c + u * (d - c);
    return above + v * (below - above);
}

// Optical depth before a layer and of its own by share (unpack_layer).
INLINE float texel_depth(uint32_t bits, float share)
{
    return ((float)(int)(bits & 0xffff) + share * (float)(int)(bits >> 16)) * (1.f / 4096);
}

// Where a tile's particles look: the texel before them, what they are beyond it, and their layer.
typedef struct Looks {
    float u[W], v[W], share[W];
    int texel[W], layer[W];
} Looks;

INLINE void find_looks(const Cast *cast, const Places *places, Looks *looks)
{
    const float *depths = cast->shadow->depths;
    int side = cast->shadow->side;
    float edge = (float)side - 1.01f, last = cast->last, begin[W];
    for (int k = 0; k < W; ++k) {
        float u = smaller(larger(places->u[k] - 0.5f, 0), edge),
              v = smaller(larger(places->v[k] - 0.5f, 0), edge);
        looks->texel[k] = (int)v * side + (int)u;
        looks->u[k] = u - (float)(int)u;
        looks->v[k] = v - (float)(int)v;
    }
    for (int k = 0; k < W; ++k) {
        int at = looks->texel[k], below = at + side;
        begin[k] = mix4(depths[at], depths[at + 1], depths[below], depths[below + 1], looks->u[k],
                        looks->v[k]);
    }
    for (int k = 0; k < W; ++k) {
        float root = sqrtf(positive(places->z[k] - begin[k])),
              layer = smaller((float)LAYERS * root, last);
        looks->layer[k] = (int)layer;
        looks->share[k] = layer - (float)(int)layer;
    }
}

// What of its own optical depth a fibre finds in its layer (OWN_SHARE of shadow.glsl).
INLINE float own_depth(float width, float opacity, float share)
{
    float kept = opacity * smaller(width, 1), beyond = smaller(larger(width - 1, 0), 1);
    return share * 0.5f * (1 + beyond) * kept * (1 + 0.5f * kept);
}

INLINE void find_lights(const Cast *cast, const Tile *tile, const Places *places, float *left)
{
    const uint32_t *layers = cast->found_layers;
    int side = cast->shadow->side, squares = side * side;
    float sum[W], most = (float)side;
    Looks looks;
    find_looks(cast, places, &looks);
    for (int k = 0; k < W; ++k) {
        int at = looks.texel[k] + looks.layer[k] * squares, below = at + side;
        float share = looks.share[k];
        sum[k] = mix4(texel_depth(layers[at], share), texel_depth(layers[at + 1], share),
                      texel_depth(layers[below], share), texel_depth(layers[below + 1], share),
                      looks.u[k], looks.v[k]);
    }
    for (int k = 0; k < W; ++k)
        sum[k] -= own_depth(2 * places->radius[k] * cast->across, tile->opacity[k], looks.share[k]);
    // Beside the map no hair stands in the light, nor behind a lamp.
    for (int k = 0; k < W; ++k) {
        bool inside = (places->u[k] >= 0) & (places->v[k] >= 0) & (places->u[k] <= most) &
                      (places->v[k] <= most);
        sum[k] *= inside ? 1.f : 0.f;
    }
    for (int k = 0; k < W; ++k) left[k] = exp2_of(-1.44269504f * positive(sum[k]));
}

INLINE void find_light(const Cast *cast, int part)
{
    const CpuCaster *caster = cast->casters.list;
    Places places;
    int range[2];
    find_range(cast, caster, part, range);
    for (int t = range[0]; t < range[1]; ++t) {
        Tile tile = open_tile(caster, t);
        for (int j = 0; j < (int)caster->material.vertex_count; ++j) {
            find_places(cast->params, &tile, j, &places);
            find_lights(cast, &tile, &places, cast->left + tile.at + (size_t)j * W);
        }
    }
}

// --- Threads, and the same code for wider lanes.

INLINE void splat(const Cast *cast, int part)
{
    if (cast->deep)
        lay_hair(cast, part, true);
    else
        lay_hair(cast, part, false);
}

#define STAGE(name)                                                                                \
    static void name##_baseline(void *cast, int part)                                              \
    {                                                                                              \
        name(cast, part);                                                                          \
    }                                                                                              \
    WIDER_STAGE(name)                                                                              \
    static void run_##name(Cast *cast)                                                             \
    {                                                                                              \
        parallel_run(cast->shadow->parts, has_avx2() ? name##_avx2 : name##_baseline, cast);       \
    }

#if defined __x86_64__
#define WIDER_STAGE(name)                                                                          \
    __attribute__((target("avx2"))) static void name##_avx2(void *cast, int part)                  \
    {                                                                                              \
        name(cast, part);                                                                          \
    }
static bool has_avx2(void)
{
    return __builtin_cpu_supports("avx2");
}
#else
#define WIDER_STAGE(name)                                                                          \
    static void name##_avx2(void *cast, int part)                                                  \
    {                                                                                              \
        name(cast, part);                                                                          \
    }
static bool has_avx2(void)
{
    return false;
}
#endif

STAGE(find_box)
STAGE(splat)
STAGE(finish)
STAGE(find_light)

bool cpu_shadow_find_box(const CpuShadow *shadow, const CastParams *params, CpuCasters casters,
                         double box[6])
{
    float boxes[PARALLEL_MOST][6];
    CpuShadow drawn = *shadow;
    Cast cast = {.shadow = &drawn, .params = params, .casters = casters, .box = boxes};
    run_find_box(&cast);
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
    run_splat(&cast);
    merge_firsts(shadow);
}

void cpu_shadow_draw_deep(CpuShadow *shadow, const CastParams *params, CpuCasters casters,
                          float *depths, uint32_t *layers)
{
    Cast cast = {.shadow = shadow,
                 .params = params,
                 .casters = casters,
                 .density = DEEP_POINTS,
                 .deep = true,
                 .layers = layers};
    find_firsts(shadow, params, casters, SHADOW_COARSE, COARSE_POINTS);
    spread(shadow);
    run_splat(&cast);
    run_finish(&cast);
    memcpy(depths, shadow->depths, (size_t)shadow->side * (size_t)shadow->side * sizeof *depths);
}

void cpu_shadow_find_light(CpuShadow *shadow, const CastParams *params, const CpuCaster *caster,
                           float across, const uint32_t *layers, float *left)
{
    Cast cast = {.shadow = shadow,
                 .params = params,
                 .casters = {caster, 1},
                 .across = across,
                 .found_layers = layers,
                 .last = (float)LAYERS - 1e-3f,
                 .left = left};
    run_find_light(&cast);
}

void cpu_shadow_draw_firsts(CpuShadow *shadow, const CastParams *params, CpuCasters casters,
                            uint32_t *firsts)
{
    size_t texels = (size_t)shadow->side * (size_t)shadow->side;
    find_firsts(shadow, params, casters, 1, FIRST_POINTS);
    for (size_t i = 0; i < texels; ++i)
        firsts[i] = (uint32_t)((double)shadow->first[i] * SHADOW_DEPTHS);
}
