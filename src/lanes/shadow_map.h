// SPDX-License-Identifier: MIT
// Makes shadow maps of hair in C: the work of the shaders shadow_bounds, shadow_splat,
// shadow_spread and shadow_finish, for CPU drivers, where one atomic addition costs as much as ten
// others. Needs no OpenGL. The maps do not depend on the number of threads.
#pragma once

#include "base/error.h"
#include "draw/mapped_caster.h"

#include <stdbool.h>

enum {
    SHADOW_MAP_TILE = 16,                    // texels of a row whose layers lie together
    SHADOW_MAP_LINES = 3 * SHADOW_LAYERS + 1 // three rows of all layers, and one more
};

// Memory for making maps. Each thread that draws hair has sums of its own, which are then added up.
// Fewer threads are used if the sums would take more than 256 MiB. Little hair is drawn by fewer
// threads, too, since clearing a thread's sums and adding them up would take longer than drawing.
typedef struct ShadowMap {
    int side, coarse; // texels across a map and across that of the first depths
    int tiles;        // SHADOW_MAP_TILEs in a row
    int wide; // row length of `sums` in a layer, chosen so that rows do not share cache lines
    bool deep;
    int parts;      // threads
    float last;     // LAYER_END: not a constant, because compilers would add jumps
    int drawers;    // threads that draw hair
    int at_once;    // number of maps that are drawn together
    int room;       // number of maps in the arrays below: at least drawers * at_once
    float *first;   // [drawers][at_once][coarse][coarse], owned; 1: no hair
    uint32_t *sums; // [drawers][at_once][side][SHADOW_LAYERS][wide], owned, deep
    float *least;   // [parts][4][coarse + 4], owned, deep: for shadow_finish.c
    float *rows;    // [parts][SHADOW_MAP_LINES][side + 2], owned, deep: the same
} ShadowMap;

// `side`: a multiple of 8. `deep`: maps have first depths and layers; otherwise only the first
// depth of every texel. RESULT_FAILED if memory is short. A zeroed struct may be destroyed.
Result shadow_map_create(ShadowMap *shadow, int side, bool deep, Error *error);
void shadow_map_destroy(ShadowMap *shadow);

// Makes room to draw this many maps of this hair. As many are drawn at once as fit into 256 MiB,
// but little hair is drawn to one map after the other, in the same memory. RESULT_FAILED if memory
// is short.
Result shadow_map_reserve(ShadowMap *shadow, int maps, MappedCasters casters, Error *error);

// Words of the layers of one map.
size_t shadow_map_layer_words(const ShadowMap *shadow);

// The box of the hair for each of `count` lights (at most MAX_LIGHTS): lowest u, v and depth, then
// the highest, of the particles within the reach of `params`. Without particles the lowest values
// exceed the highest.
void shadow_map_find_boxes(const ShadowMap *shadow, const CastParams *params, int count,
                           MappedCasters casters, double (*boxes)[6]);

// Draws all maps, after shadow_map_reserve. depths[map][side][side] is the depth at which hair
// begins (not deep: the first depth, 1 where there is no hair). Deep maps also have
// layers[map][row][column / SHADOW_MAP_TILE][SHADOW_LAYERS][SHADOW_MAP_TILE], packed by pack_layer;
// columns beyond the side are undefined.
void shadow_map_draw(ShadowMap *shadow, const CastParams *params, int maps, MappedCasters casters,
                     float *depths, uint32_t *layers);
