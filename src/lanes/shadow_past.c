// SPDX-License-Identifier: MIT
#include "lanes/shadow_past.h"

#include "lanes/shadow_tile.h"

#include <stdbool.h>
#include <stdlib.h>

enum { SQUARE = 16 }; // texels: side of what has one pair of bounds

// --- Bounds.

typedef struct Bounding {
    const float *depths;
    float (*bounds)[2];
    int side, rows, parts; // texels across a map, squares down all maps
} Bounding;

static float larger(float a, float b)
{
    return a > b ? a : b;
}

// A point in the square looks at a texel and at the next one each way, never beyond its map.
SIMD_INLINE void bound_square(const float *first, int side, int wide, int high, float bounds[2])
{
    float least[SQUARE], most[SQUARE], low, top;
    for (int k = 0; k < SQUARE; ++k) least[k] = most[k] = first[k];
    low = top = first[wide - 1];
    for (int y = 0; y < high; ++y) {
        const float *row = first + (ptrdiff_t)y * side;
        for (int k = 0; k < SQUARE; ++k) {
            least[k] = simd_min(row[k], least[k]);
            most[k] = simd_max(row[k], most[k]);
        }
        low = simd_min(row[wide - 1], low);
        top = simd_max(row[wide - 1], top);
    }
    for (int k = 0; k < SQUARE; ++k) low = simd_min(least[k], low), top = larger(most[k], top);
    bounds[0] = low;
    bounds[1] = top;
}

SIMD_INLINE void bound_squares(const Bounding *all, int part)
{
    int across = all->side / SQUARE, end = all->rows * (part + 1) / all->parts;
    for (int row = all->rows * part / all->parts; row < end; ++row)
        for (int column = 0; column < across; ++column) {
            int wide = column + 1 < across ? SQUARE + 1 : SQUARE,
                high = row % across + 1 < across ? SQUARE + 1 : SQUARE;
            bound_square(all->depths + (ptrdiff_t)row * SQUARE * all->side + column * SQUARE,
                         all->side, wide, high, all->bounds[row * across + column]);
        }
}

SIMD_STAGE(bound_squares, Bounding)

Result shadow_past_begin(ShadowPast *past, const ShadowParams *params, const float *depths,
                         int parts, Error *error)
{
    int across = params->mesh_side / SQUARE;
    size_t count = (size_t)params->maps * (size_t)across * (size_t)across;
    if (past->room < count) {
        shadow_past_destroy(past);
        past->bounds = malloc(count * sizeof *past->bounds);
        if (!past->bounds)
            return error_set(error, RESULT_FAILED, "no memory for shadows of the mesh");
        past->room = count;
    }
    Bounding all = {depths, past->bounds, params->mesh_side, params->maps * across, parts};
    run_bound_squares(&all, parts);
    return RESULT_OK;
}

void shadow_past_destroy(ShadowPast *past)
{
    free(past->bounds);
    *past = (ShadowPast){0};
}

// --- Points.

typedef struct Search {
    const ShadowPast *past;
    const ShadowParams *params;
    const float *depths;
    const MappedCaster *caster;
    size_t points;
    const float *left;
    float *reaching;
    int parts;
} Search;

// Where a point of each of a tile's strands looks at the mesh's map.
typedef struct Looks {
    float u[W], v[W];           // of the way from the texel to the next one
    float depth[W];             // its own
    int texel[W], square[W];    // the first of the four texels; whose bounds hold for them
    float past[W], on_light[W]; // what is left; 1: before the light, 0: behind a lamp
} Looks;

SIMD_INLINE void find_looks(const ShadowParams *params, int map, const float x[3][W], Looks *looks)
{
    const float(*rows)[4] = (const float(*)[4])params->mesh_from_world[map],
          *before = params->from_world[map][3];
    int side = params->mesh_side, across = side / SQUARE;
    float edge = (float)(side - 2), shift = params->place[map][2];
    for (int k = 0; k < W; ++k) {
        float p = x[0][k], q = x[1][k], r = x[2][k];
        float w = rows[3][0] * p + rows[3][1] * q + rows[3][2] * r + rows[3][3],
              u = (rows[0][0] * p + rows[0][1] * q + rows[0][2] * r + rows[0][3]) / w - 0.5f,
              v = (rows[1][0] * p + rows[1][1] * q + rows[1][2] * r + rows[1][3]) / w - 0.5f,
              z = (rows[2][0] * p + rows[2][1] * q + rows[2][2] * r + rows[2][3]) / w - shift;
        u = simd_min(simd_max(u, 0), edge);
        v = simd_min(simd_max(v, 0), edge);
        int column = (int)u, row = (int)v;
        looks->u[k] = u - (float)column;
        looks->v[k] = v - (float)row;
        looks->depth[k] = simd_min(z, 1);
        looks->texel[k] = row * side + column;
        looks->square[k] = row / SQUARE * across + column / SQUARE;
        float light = before[0] * p + before[1] * q + before[2] * r + before[3];
        looks->on_light[k] = light > 0 ? 1.f : 0.f;
    }
}

// Decides by the bounds; returns for how many they do not. Those look at the texels themselves, the
// others at the map's first ones.
SIMD_INLINE int decide(const float (*bounds)[2], Looks *looks)
{
    int open = 0;
    for (int k = 0; k < W; ++k) {
        float least = bounds[looks->square[k]][0], most = bounds[looks->square[k]][1],
              depth = looks->depth[k];
        int undecided = (least < depth) & (most >= depth);
        looks->past[k] = least < depth ? 0.f : 1.f;
        looks->texel[k] = undecided ? looks->texel[k] : 0;
        looks->square[k] = undecided;
        open += undecided;
    }
    return open;
}

// The share of a square as wide as a texel around the point that the mesh does not stand before.
SIMD_INLINE void look(const float *depths, int side, Looks *looks)
{
    for (int k = 0; k < W; ++k) {
        int at = looks->texel[k], below = at + side;
        float depth = looks->depth[k], u = looks->u[k], v = looks->v[k];
        float above = (depths[at] < depth ? 0 : 1 - u) + (depths[at + 1] < depth ? 0 : u),
              under = (depths[below] < depth ? 0 : 1 - u) + (depths[below + 1] < depth ? 0 : u);
        looks->past[k] = looks->square[k] ? v * under + (1 - v) * above : looks->past[k];
    }
}

SIMD_INLINE void find_tile(const Search *search, const Tile *tile)
{
    const ShadowParams *params = search->params;
    size_t count = (size_t)mapped_caster_points(search->caster), side = (size_t)params->mesh_side,
           squares = side / SQUARE * (side / SQUARE);
    float own[3][W];
    Looks looks;
    for (size_t j = 0; j < count; ++j) {
        const float(*x)[W] = find_points(tile, (int)j, own);
        for (int map = 0; map < params->maps; ++map) {
            const float *depths = search->depths + (size_t)map * side * side;
            find_looks(params, map, x, &looks);
            if (decide((const float(*)[2])search->past->bounds + (size_t)map * squares, &looks))
                look(depths, params->mesh_side, &looks);
            size_t at = (size_t)map * search->points + (tile->number * count + j) * W;
            for (int k = 0; k < W; ++k) {
                float past = looks.on_light[k] > 0 ? looks.past[k] : 1;
                search->reaching[at + (size_t)k] = search->left[at + (size_t)k] * past;
            }
        }
    }
}

SIMD_INLINE void find_past(const Search *search, int part)
{
    int range[2];
    find_range(search->caster, part, search->parts, range);
    for (int t = range[0]; t < range[1]; ++t) {
        Tile tile = open_tile(search->caster, t);
        find_tile(search, &tile);
    }
}

SIMD_STAGE(find_past, Search)

void shadow_past_find(const ShadowPast *past, const ShadowParams *params, const float *depths,
                      const MappedCaster *caster, size_t points, const float *left, float *reaching,
                      int parts)
{
    Search search = {past, params, depths, caster, points, left, reaching, parts};
    run_find_past(&search, parts);
}
