// SPDX-License-Identifier: MIT
// How much of each light passes hair: shadow maps made by compute shaders.
//
// A deep opacity map has for each texel the depth at which hair begins, and the number of fibres in
// each of the layers behind. A map for `approx` has only the first depth.
#pragma once

#include "draw/look.h"
#include "draw/shadow_frames.h"
#include "gpu/gpu_buffer.h"
#include "gpu/shader.h"
#include "sim/hair.h"

// Hair that casts shadows: the drawn ribbons, with the material's shadow_opacity.
typedef struct ShadowCaster {
    const HairBatch *batch;
    const Look *look;
} ShadowCaster;

typedef struct ShadowCasters {
    const ShadowCaster *list;
    uint32_t count;
} ShadowCasters;

enum { CAST_PAINT = 1, CAST_SMOOTH = 2, CAST_VARIANTS = 4 }; // features of the ribbons' shaders
unsigned hair_shadow_variant(const ShadowCaster *caster);

// The float whose bits shaders have compared as this integer (glsl/draw/bounds.glsl).
float hair_shadow_unordered(int32_t bits);

typedef struct HairShadow {
    bool deep;
    int side; // texels across a map
    const GpuLimits *limits;
    GLuint first[CAST_VARIANTS], splat[CAST_VARIANTS]; // programs
    GLuint bounds, spread, finish;
    GpuBuffer box, firsts, depths, sums, layers; // see shadow.h
    int maps;                                    // number that the buffers have room for
} HairShadow;

// `side`: a multiple of 8.
void hair_shadow_create(HairShadow *hair, const GpuLimits *limits, bool deep, int side);
void hair_shadow_destroy(HairShadow *hair);

// Compiles the shaders for hair with the CAST_ bits `variant`, unless they are there.
Result hair_shadow_build(HairShadow *hair, unsigned variant, Error *error);

// Clears all `maps` maps, and compiles the shaders for this hair, unless they are there.
// RESULT_FAILED if memory is short or a shader does not compile.
Result hair_shadow_begin(HairShadow *hair, int maps, ShadowCasters casters, Error *error);

// The box of all hair as each light that casts shadows sees it (light_frame.h). Without hair the
// lowest place exceeds the highest. Waits for the GPU, once.
void hair_shadow_find_boxes(HairShadow *hair, const ShadowFrames *frames, ShadowCasters casters,
                            double (*boxes)[6]);

// Draws map `map` at its place.
void hair_shadow_draw(HairShadow *hair, const ShadowFrames *frames, int map, ShadowCasters casters);

// Binds the inputs of glsl/draw/shadow.glsl.
void hair_shadow_bind(const HairShadow *hair);
