// SPDX-License-Identifier: MIT
// Shadow maps of hair made by the processor's own lanes and threads: what the shaders
// shadow_bounds, shadow_splat, shadow_spread and shadow_finish do, for CPU drivers, where an atomic
// addition costs what ten others do. Needs no OpenGL. The same maps whatever number of threads.
#pragma once

#include "base/error.h"
#include "base/parallel.h"

#include "glsl/draw/material.h"
#include "glsl/draw/shadow.h"

#include <stdbool.h>

// Hair that stands in the light, laid out as in HairBatch; smooth_parts is 1.
typedef struct CpuCaster {
    const float (*position)[4];
    const uint32_t (*paint)[4]; // see hair_paint.c; NULL: none
    MaterialParams material;
} CpuCaster;

typedef struct CpuCasters {
    const CpuCaster *list;
    uint32_t count;
} CpuCasters;

// Each thread draws into a map of its own; sums and minima of them all are the map. There are fewer
// threads where such maps would take more than 256 MiB.
typedef struct CpuShadow {
    int side, coarse; // texels across a map and across that of the first depths
    bool deep;
    int parts;
    float *first;   // [parts][coarse][coarse], owned; 1: no hair
    float *least;   // [2][coarse + 2][coarse + 2], owned, deep: for spread
    float *depths;  // [side][side], owned, deep: where layers begin
    uint32_t *sums; // [parts][side][SHADOW_LAYERS][side], owned, deep
    float *rows;    // owned, deep: of each part three rows of all layers, and two more
} CpuShadow;

// `side`: a multiple of 8. `deep`: first depths and layers, else first depths alone, of every
// texel. RESULT_FAILED when memory is short. Destroying a zeroed struct is legal.
Result cpu_shadow_create(CpuShadow *shadow, int side, bool deep, Error *error);
void cpu_shadow_destroy(CpuShadow *shadow);

// Lowest u, v and depth, then the highest, of particles within the reach of `params`; false if
// there are none.
bool cpu_shadow_find_box(const CpuShadow *shadow, const CastParams *params, CpuCasters casters,
                         double box[6]);

// One map as shaders read it: deep, depths[side][side] and layers[SHADOW_LAYERS][side][side].
void cpu_shadow_draw_deep(CpuShadow *shadow, const CastParams *params, CpuCasters casters,
                          float *depths, uint32_t *layers);

// Not deep: firsts[side][side].
void cpu_shadow_draw_firsts(CpuShadow *shadow, const CastParams *params, CpuCasters casters,
                            uint32_t *firsts);
