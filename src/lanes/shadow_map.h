// SPDX-License-Identifier: MIT
// Shadow maps of hair made by the processor's own lanes and threads: what the shaders
// shadow_bounds, shadow_splat, shadow_spread and shadow_finish do, for CPU drivers, where an atomic
// addition costs what ten others do. Needs no OpenGL. The same maps whatever number of threads.
#pragma once

#include "base/error.h"
#include "draw/mapped_caster.h"

#include <stdbool.h>

enum {
    SHADOW_MAP_TILE = 16,                    // texels of a row whose layers lie together
    SHADOW_MAP_LINES = 3 * SHADOW_LAYERS + 1 // three rows of all layers, and one more
};

// What maps are made with. Each thread draws into sums of its own; those of them all are the map.
// There are fewer threads where sums would take more than 256 MiB.
typedef struct ShadowMap {
    int side, coarse; // texels across a map and across that of the first depths
    int tiles;        // SHADOW_MAP_TILEs in a row
    int wide;         // of `sums`, from row to row of a layer: rows must not share lines of caches
    bool deep;
    int parts;
    float last;     // LAYER_END: a bound that compilers know makes them jump
    int at_once;    // maps that there is room for in what follows
    float *first;   // [parts][at_once][coarse][coarse], owned; 1: no hair
    uint32_t *sums; // [parts][at_once][side][SHADOW_LAYERS][wide], owned, deep
    float *least;   // [parts][4][coarse + 4], owned, deep: for shadow_finish.c
    float *rows;    // [parts][SHADOW_MAP_LINES][side + 2], owned, deep: the same
} ShadowMap;

// `side`: a multiple of 8. `deep`: first depths and layers, else first depths alone, of every
// texel. RESULT_FAILED when memory is short. Destroying a zeroed struct is legal.
Result shadow_map_create(ShadowMap *shadow, int side, bool deep, Error *error);
void shadow_map_destroy(ShadowMap *shadow);

// Room to draw so many maps, as many at once as take no more than 256 MiB. RESULT_FAILED if memory
// is short.
Result shadow_map_reserve(ShadowMap *shadow, int maps, Error *error);

// Words of the layers of one map.
size_t shadow_map_layer_words(const ShadowMap *shadow);

// Of each of `count` lights, at most MAX_LIGHTS, lowest u, v and depth, then the highest, of
// particles within the reach of `params`; the lowest are above the highest if there are none.
void shadow_map_find_boxes(const ShadowMap *shadow, const CastParams *params, int count,
                           MappedCasters casters, double (*boxes)[6]);

// All maps, for which there is room: depths[map][side][side], at which hair begins (not deep: its
// first depths, 1 where there is none), and, deep, layers[map][row][column / SHADOW_MAP_TILE]
// [SHADOW_LAYERS][SHADOW_MAP_TILE], as pack_layer has them; columns beyond the side are undefined.
void shadow_map_draw(ShadowMap *shadow, const CastParams *params, int maps, MappedCasters casters,
                     float *depths, uint32_t *layers);
