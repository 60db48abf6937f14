// SPDX-License-Identifier: MIT
#include "lanes/shadow_finish.h"

#include "base/simd.h"

#include <string.h>

enum { LAYERS = SHADOW_LAYERS, C = SHADOW_COARSE, T = SHADOW_MAP_TILE };

static size_t texels_of(const ShadowMap *shadow)
{
    return (size_t)shadow->coarse * (size_t)shadow->coarse;
}

// --- The depth at which layers begin.

typedef struct Spread {
    ShadowMap *shadow;
    int map;
    float *depths;
} Spread;

// The minimum over all threads' first depths, stored in the first thread's array.
static float *merge_firsts(ShadowMap *shadow, int map)
{
    size_t texels = texels_of(shadow), step = texels * (size_t)shadow->at_once;
    float *first = shadow->first + (size_t)map * texels;
    for (int part = 1; part < shadow->drawers; ++part) {
        const float *other = first + (size_t)part * step;
        for (size_t i = 0; i < texels; ++i) first[i] = simd_min(other[i], first[i]);
    }
    return first;
}

static int within(int i, int count)
{
    return i < 0 ? 0 : i >= count ? count - 1 : i;
}

// The minimum of 3 x 3 coarse texels along row y, which may be one outside the map. `least` has
// coarse + 2 values and begins one texel before the first.
SIMD_INLINE void find_least(const float *first, int coarse, int y, float *line, float *least)
{
    const float *a = first + within(y - 1, coarse) * coarse,
                *b = first + within(y, coarse) * coarse,
                *c = first + within(y + 1, coarse) * coarse;
    for (int x = 0; x < coarse; ++x) line[x + 2] = simd_min(a[x], simd_min(b[x], c[x]));
    line[0] = line[1] = line[2];
    line[coarse + 2] = line[coarse + 3] = line[coarse + 1];
    for (int x = 0; x < coarse + 2; ++x)
        least[x] = simd_min(line[x], simd_min(line[x + 1], line[x + 2]));
}

// Interpolates linearly between two coarse rows, `above` and `below`: writes C rows from C * y - C
// / 2 on.
SIMD_INLINE void spread_rows(const Spread *spread, int y, const float *above, const float *below,
                             float *edge)
{
    int side = spread->shadow->side, coarse = spread->shadow->coarse;
    for (int j = 0; j < C; ++j) {
        int row = y * C - C / 2 + j;
        if (row < 0 || row >= side) continue;
        float share = ((float)j + 0.5f) / C, *out = spread->depths + (size_t)row * (size_t)side;
        for (int i = 0; i < coarse + 2; ++i) edge[i] = above[i] + share * (below[i] - above[i]);
        for (int x = 0; x < C / 2; ++x) { // the texels at both ends of the row
            float along = ((float)x + 0.5f) / C;
            out[x] = edge[0] + (along + 0.5f) * (edge[1] - edge[0]);
            out[side - C / 2 + x] = edge[coarse] + along * (edge[coarse + 1] - edge[coarse]);
        }
        for (int i = 1; i < coarse; ++i)
            for (int x = 0; x < C; ++x)
                out[i * C - C / 2 + x] = edge[i] + ((float)x + 0.5f) / C * (edge[i + 1] - edge[i]);
    }
}

// Each part processes some of the coarse rows with the rows of texels above them.
SIMD_INLINE void spread_part(const Spread *spread, int part)
{
    const ShadowMap *shadow = spread->shadow;
    int coarse = shadow->coarse, wide = coarse + 4, rows = coarse + 1;
    int y = rows * part / shadow->parts, end = rows * (part + 1) / shadow->parts;
    const float *first = shadow->first + (size_t)spread->map * texels_of(shadow);
    float *line = shadow->least + (size_t)part * 4 * (size_t)wide, *edge = line + wide,
          *above = edge + wide, *below = above + wide;
    find_least(first, coarse, y - 1, line, above);
    for (; y < end; ++y) {
        find_least(first, coarse, y, line, below);
        spread_rows(spread, y, above, below, edge);
        float *next = above;
        above = below, below = next;
    }
}

SIMD_STAGE(spread_part, Spread)

void shadow_finish_spread(ShadowMap *shadow, int map, float *depths)
{
    merge_firsts(shadow, map);
    Spread spread = {shadow, map, depths};
    run_spread_part(&spread, shadow->parts);
}

void shadow_finish_firsts(ShadowMap *shadow, int map, float *depths)
{
    memcpy(depths, merge_firsts(shadow, map), texels_of(shadow) * sizeof *depths);
}

// --- Layers.

typedef struct Finish {
    const ShadowMap *shadow;
    int map;
    float unit;
    uint32_t *layers; // [side][tiles][LAYERS][T]
} Finish;

// Adds up all threads' sums of a row and smooths them along the row (1 2 1). Outside the map the
// outermost texels are repeated.
SIMD_INLINE void gather_row(const ShadowMap *shadow, int map, int row, float *line, float *smooth)
{
    int side = shadow->side;
    row = row < 0 ? 0 : row >= side ? side - 1 : row;
    size_t wide = (size_t)shadow->wide, words = (size_t)side * LAYERS * wide,
           step = words * (size_t)shadow->at_once;
    for (size_t layer = 0; layer < LAYERS; ++layer, smooth += side) {
        const uint32_t *sums =
            shadow->sums + (size_t)map * words + ((size_t)row * LAYERS + layer) * wide;
        for (int x = 0; x < side; ++x) line[x + 1] = (float)(int)sums[x];
        for (int part = 1; part < shadow->drawers; ++part) {
            sums += step;
            for (int x = 0; x < side; ++x) line[x + 1] += (float)(int)sums[x];
        }
        line[0] = line[1];
        line[side + 1] = line[side];
        for (int x = 0; x < side; ++x) smooth[x] = line[x] + 2 * line[x + 1] + line[x + 2];
    }
}

// Smooths across three rows, and sums up the layers from the first to the last.
SIMD_INLINE void finish_row(const Finish *maps, int row, float *const rows[3])
{
    size_t side = (size_t)maps->shadow->side, tiles = (size_t)maps->shadow->tiles;
    uint32_t *out = maps->layers + (size_t)row * tiles * LAYERS * T;
    float scale = 1 / (16 * maps->unit);
    for (size_t x = 0; x < side; x += T) {
        float before[T] = {0};
        for (size_t layer = 0; layer < LAYERS; ++layer, out += T) {
            const float *a = rows[0] + layer * side + x, *b = rows[1] + layer * side + x,
                        *c = rows[2] + layer * side + x;
            for (int k = 0; k < T; ++k) {
                float own = scale * (a[k] + 2 * b[k] + c[k]);
                out[k] = pack_layer(before[k], own);
                before[k] += own;
            }
        }
    }
}

SIMD_INLINE void finish(const Finish *maps, int part)
{
    const ShadowMap *shadow = maps->shadow;
    size_t side = (size_t)shadow->side;
    int row = shadow->side * part / shadow->parts, end = shadow->side * (part + 1) / shadow->parts;
    float *line = shadow->rows + (size_t)part * SHADOW_MAP_LINES * (side + 2), *rows[3];
    for (int i = 0; i < 3; ++i) rows[i] = line + side + 2 + (size_t)i * LAYERS * side;
    gather_row(shadow, maps->map, row - 1, line, rows[0]);
    gather_row(shadow, maps->map, row, line, rows[1]);
    for (; row < end; ++row) {
        gather_row(shadow, maps->map, row + 1, line, rows[2]);
        finish_row(maps, row, rows);
        float *above = rows[0];
        rows[0] = rows[1], rows[1] = rows[2], rows[2] = above;
    }
}

SIMD_STAGE(finish, Finish)

void shadow_finish_layers(ShadowMap *shadow, int map, float unit, uint32_t *layers)
{
    Finish all = {shadow, map, unit, layers};
    run_finish(&all, shadow->parts);
}
