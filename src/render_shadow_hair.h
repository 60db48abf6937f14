// SPDX-License-Identifier: MIT
// What hair lets through of each light: maps made in compute, for either rasteriser.
//
// A deep opacity map has for each texel the depth at which hair begins and the optical depth of the
// layers behind. An approximated one has the first depth only.
#pragma once

#include "light_frame.h"
#include "render_look.h"

#include "shadow.h"

// Hair that stands in the light: the ribbons that are drawn, with the material's shadow_opacity.
typedef struct ShadowCaster {
    const HairBatch *batch;
    Look look;
} ShadowCaster;

typedef struct ShadowCasters {
    const ShadowCaster *list;
    uint32_t count;
} ShadowCasters;

enum { CAST_PAINT = 1, CAST_SMOOTH = 2, CAST_VARIANTS = 4 }; // what the ribbons' shaders need

typedef struct RenderShadowHair {
    bool deep;
    int side; // texels across a map
    const GpuLimits *limits;
    GLuint bounds[CAST_VARIANTS], first[CAST_VARIANTS], splat[CAST_VARIANTS]; // programs
    GLuint spread, finish;
    GpuBuffer box, firsts, depths, sums, layers; // see shadow.h
    GpuBuffer cast_uniforms, material;
    int maps; // there is room for
} RenderShadowHair;

// `side`: a multiple of 8.
Result render_shadow_hair_create(RenderShadowHair *hair, const GpuLimits *limits, bool deep,
                                 int side, Error *error);
void render_shadow_hair_destroy(RenderShadowHair *hair);

// Compiles the shaders for hair that needs CAST_ bits `variant`, unless they are there.
Result render_shadow_hair_build(RenderShadowHair *hair, unsigned variant, Error *error);

// Room for so many maps, and the shaders for such hair; nothing if all is there. RESULT_FAILED if
// memory is short or a shader does not compile.
Result render_shadow_hair_reserve(RenderShadowHair *hair, int maps, ShadowCasters casters,
                                  Error *error);

// The box (see light_frame.h) of all hair before the light; false if there is none. Waits for the
// GPU.
bool render_shadow_hair_find_box(RenderShadowHair *hair, const LightView *view,
                                 ShadowCasters casters, double box[6]);

// Where a map of hair in `box` lies.
LightFrame render_shadow_hair_frame(const RenderShadowHair *hair, const LightView *view,
                                    const double box[6]);

// Empties all maps; draws map `map`.
void render_shadow_hair_clear(const RenderShadowHair *hair);
void render_shadow_hair_draw(RenderShadowHair *hair, const LightView *view, const LightFrame *frame,
                             int map, ShadowCasters casters);

// Binds what glsl/shadow.glsl reads.
void render_shadow_hair_bind(const RenderShadowHair *hair);
