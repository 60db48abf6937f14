// SPDX-License-Identifier: MIT
// Shadow maps of hair made by the processor's own lanes and threads: what the shaders
// shadow_bounds, shadow_splat, shadow_spread and shadow_finish do, for CPU drivers, where an atomic
// addition costs what ten others do. Needs no OpenGL. The same maps whatever number of threads.
#pragma once

#include "base/error.h"
#include "lanes/mapped_caster.h"

#include <stdbool.h>

// Each thread draws into a map of its own; sums and minima of them all are the map. There are fewer
// threads where such maps would take more than 256 MiB.
typedef struct ShadowMap {
    int side, coarse; // texels across a map and across that of the first depths
    int wide;         // of `sums`, from row to row of a layer: rows must not share lines of caches
    bool deep;
    int parts;
    float *first;   // [parts][coarse][coarse], owned; 1: no hair
    float *least;   // [2][coarse + 2][coarse + 2], owned, deep: for spread
    float *depths;  // [side][side], owned, deep: where layers begin
    uint32_t *sums; // [parts][side][SHADOW_LAYERS][wide], owned, deep
    float *rows;    // owned, deep: for finish
} ShadowMap;

// `side`: a multiple of 8. `deep`: first depths and layers, else first depths alone, of every
// texel. RESULT_FAILED when memory is short. Destroying a zeroed struct is legal.
Result shadow_map_create(ShadowMap *shadow, int side, bool deep, Error *error);
void shadow_map_destroy(ShadowMap *shadow);

// Lowest u, v and depth, then the highest, of particles within the reach of `params`; false if
// there are none.
bool shadow_map_find_box(const ShadowMap *shadow, const CastParams *params, MappedCasters casters,
                         double box[6]);

// One map as shaders read it: deep, depths[side][side] and layers[SHADOW_LAYERS][side][side].
void shadow_map_draw_deep(ShadowMap *shadow, const CastParams *params, MappedCasters casters,
                          float *depths, uint32_t *layers);

// Not deep: firsts[side][side].
void shadow_map_draw_firsts(ShadowMap *shadow, const CastParams *params, MappedCasters casters,
                            uint32_t *firsts);
