// SPDX-License-Identifier: MIT
// What hair lets through of each light: maps made in compute, for either rasteriser.
//
// A deep opacity map has for each texel the depth at which hair begins and the optical depth of the
// layers behind. An approximated one has the first depth only.
#pragma once

#include "hair.h"
#include "light_frame.h"
#include "shader.h"

#include "shadow.h"

// Hair that stands in the light.
typedef struct ShadowCaster {
    const HairBatch *batch;
    float radius; // m, at the root
    float tip_ratio, opacity;
} ShadowCaster;

typedef struct ShadowCasters {
    const ShadowCaster *list;
    uint32_t count;
} ShadowCasters;

typedef struct RenderShadowHair {
    bool deep;
    int side; // texels across a map
    const GpuLimits *limits;
    GLuint bounds, first, spread, splat, finish; // programs
    GpuBuffer box, firsts, depths, sums, layers; // see shadow.h
    GpuBuffer cast_uniforms;
    int maps; // there is room for
} RenderShadowHair;

// `side`: a multiple of 8.
Result render_shadow_hair_create(RenderShadowHair *hair, const GpuLimits *limits, bool deep,
                                 int side, Error *error);
void render_shadow_hair_destroy(RenderShadowHair *hair);

// Room for so many maps; nothing if there is. RESULT_FAILED if memory is short.
Result render_shadow_hair_reserve(RenderShadowHair *hair, int maps, Error *error);

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
