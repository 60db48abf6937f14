// SPDX-License-Identifier: MIT
// What hair lets through of each light: maps made in compute or, where the driver is the
// processor's, by C (curves excepted), for either rasteriser.
//
// A deep opacity map has for each texel the depth at which hair begins and the optical depth of the
// layers behind. An approximated one has the first depth only.
#pragma once

#include "draw/light_frame.h"
#include "draw/render_shadow_cpu.h"

enum { CAST_PAINT = 1, CAST_SMOOTH = 2, CAST_VARIANTS = 4 }; // what the ribbons' shaders need

typedef struct RenderShadowHair {
    bool deep, by_processor;
    bool in_c; // the maps at hand are made by `cpu`
    RenderShadowCpu cpu;
    int side; // texels across a map
    const GpuLimits *limits;
    GLuint bounds[CAST_VARIANTS], first[CAST_VARIANTS], splat[CAST_VARIANTS]; // programs
    GLuint spread, finish;
    GpuBuffer box, firsts, depths, sums, layers; // see shadow.h
    GpuBuffer cast_uniforms, material;
    int maps; // there is room for
} RenderShadowHair;

// `side`: a multiple of 8. `by_processor`: C makes the maps where it can.
Result render_shadow_hair_create(RenderShadowHair *hair, const GpuLimits *limits, bool deep,
                                 int side, bool by_processor, Error *error);
void render_shadow_hair_destroy(RenderShadowHair *hair);

// Compiles the shaders for hair that needs CAST_ bits `variant`, unless they are there.
Result render_shadow_hair_build(RenderShadowHair *hair, unsigned variant, Error *error);

// Empties all maps, of which there are `maps`, and makes the shaders for such hair if they are
// needed and not there yet. RESULT_FAILED if memory is short or a shader does not compile.
Result render_shadow_hair_begin(RenderShadowHair *hair, int maps, ShadowCasters casters,
                                Error *error);

// Between begin and end.

// The box (see light_frame.h) of all hair before the light; false if there is none. Waits for the
// GPU.
bool render_shadow_hair_find_box(RenderShadowHair *hair, const LightView *view,
                                 ShadowCasters casters, double box[6]);

// Where a map of hair in `box` lies.
LightFrame render_shadow_hair_frame(const RenderShadowHair *hair, const LightView *view,
                                    const double box[6]);

// Texels of such a map in a metre across, about.
float render_shadow_hair_scale(const LightView *view, const LightFrame *frame);

// Draws map `map`.
void render_shadow_hair_draw(RenderShadowHair *hair, const LightView *view, const LightFrame *frame,
                             int map, ShadowCasters casters);

void render_shadow_hair_end(RenderShadowHair *hair);

// The light at all particles of the casters, if C has found it: false where shaders look for it.
bool render_shadow_hair_lights(const RenderShadowHair *hair, const ParticleLight **lights,
                               uint32_t *count);

// Binds what glsl/draw/shadow.glsl reads.
void render_shadow_hair_bind(const RenderShadowHair *hair);
