// SPDX-License-Identifier: MIT
// What hair lets through of each light: maps made in compute.
//
// A deep opacity map has for each texel the depth at which hair begins and the fibres in the
// layers behind. An approximated one has the first depth only.
#pragma once

#include "draw/look.h"
#include "draw/shadow_frames.h"
#include "gpu/gpu_buffer.h"
#include "gpu/shader.h"
#include "sim/hair.h"

// Hair that stands in the light: the ribbons that are drawn, with the material's shadow_opacity.
typedef struct ShadowCaster {
    const HairBatch *batch;
    const Look *look;
} ShadowCaster;

typedef struct ShadowCasters {
    const ShadowCaster *list;
    uint32_t count;
} ShadowCasters;

enum { CAST_PAINT = 1, CAST_SMOOTH = 2, CAST_VARIANTS = 4 }; // what the ribbons' shaders need
unsigned hair_shadow_variant(const ShadowCaster *caster);

// The float whose bits shaders have compared as this int (glsl/draw/bounds.glsl).
float hair_shadow_unordered(int32_t bits);

typedef struct HairShadow {
    bool deep;
    int side; // texels across a map
    const GpuLimits *limits;
    GLuint first[CAST_VARIANTS], splat[CAST_VARIANTS]; // programs
    GLuint bounds, spread, finish;
    GpuBuffer box, firsts, depths, sums, layers; // see shadow.h
    int maps;                                    // there is room for
} HairShadow;

// `side`: a multiple of 8.
void hair_shadow_create(HairShadow *hair, const GpuLimits *limits, bool deep, int side);
void hair_shadow_destroy(HairShadow *hair);

// Compiles the shaders for hair that needs CAST_ bits `variant`, unless they are there.
Result hair_shadow_build(HairShadow *hair, unsigned variant, Error *error);

// Empties all maps, of which there are `maps`, and makes the shaders for such hair if they are
// needed and not there yet. RESULT_FAILED if memory is short or a shader does not compile.
Result hair_shadow_begin(HairShadow *hair, int maps, ShadowCasters casters, Error *error);

// Of each light that casts shadows the box (see light_frame.h) of all hair before it; the lowest
// place is above the highest if there is none. Waits for the GPU, once.
void hair_shadow_find_boxes(HairShadow *hair, const ShadowFrames *frames, ShadowCasters casters,
                            double (*boxes)[6]);

// Draws map `map`, as it is placed.
void hair_shadow_draw(HairShadow *hair, const ShadowFrames *frames, int map, ShadowCasters casters);

// Binds what glsl/draw/shadow.glsl reads.
void hair_shadow_bind(const HairShadow *hair);
