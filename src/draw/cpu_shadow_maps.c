// SPDX-License-Identifier: MIT
#include "draw/cpu_shadow_maps.h"

#include "base/simd.h"

enum { LAYERS = SHADOW_LAYERS };

typedef struct Maps {
    const CpuShadow *shadow;
    float unit;
    uint32_t *layers; // [LAYERS][side][side]
} Maps;

// A row's sums of all threads, smoothed with their neighbours (1 2 1); beyond the edges stand the
// outermost again.
SIMD_INLINE void gather_row(const CpuShadow *shadow, int row, float *line, float *smooth)
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
SIMD_INLINE uint32_t pack_layer(float before, float own)
{
    const float steps = 4096, most = 65535;
    return (uint32_t)(int)simd_min(before * steps + 0.5f, most) |
           (uint32_t)(int)simd_min(own * steps + 0.5f, most) << 16;
}

// Smooths the other way and adds up, layer by layer: three rows of all layers to one.
SIMD_INLINE void finish_row(const Maps *maps, int row, float *const rows[3], float *before)
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

SIMD_INLINE void finish(const Maps *maps, int part)
{
    const CpuShadow *shadow = maps->shadow;
    size_t side = (size_t)shadow->side;
    int row = shadow->side * part / shadow->parts, end = shadow->side * (part + 1) / shadow->parts;
    float *line = shadow->rows + (size_t)part * CPU_SHADOW_LINES * (side + 2),
          *before = line + side + 2, *rows[3];
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

SIMD_STAGE(finish, Maps)

void cpu_shadow_finish(CpuShadow *shadow, float unit, uint32_t *layers)
{
    Maps maps = {.shadow = shadow, .unit = unit, .layers = layers};
    run_finish(&maps, shadow->parts);
}

void cpu_shadow_merge_firsts(CpuShadow *shadow)
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

// As shadow_spread.comp: the least of 3 x 3 coarse texels, then linear between them.
void cpu_shadow_spread(CpuShadow *shadow)
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
