// SPDX-License-Identifier: MIT
// What hair lets through of each light: maps made in compute or, where the driver is the
// processor's, by C, for either rasteriser.
//
// A deep opacity map has for each texel the depth at which hair begins and the fibres in the
// layers behind. An approximated one has the first depth only.
#pragma once

#include "draw/hair_shadow_cpu.h"
#include "draw/light_frame.h"

enum { CAST_PAINT = 1, CAST_SMOOTH = 2, CAST_VARIANTS = 4 }; // what the ribbons' shaders need
unsigned hair_shadow_variant(const ShadowCaster *caster);

// The float whose bits shaders have compared as this int (glsl/draw/bounds.glsl).
float hair_shadow_unordered(int32_t bits);

typedef struct HairShadow {
    bool deep, by_processor;
    HairShadowCpu cpu;
    int side; // texels across a map
    const GpuLimits *limits;
    GLuint bounds[CAST_VARIANTS], first[CAST_VARIANTS], splat[CAST_VARIANTS]; // programs
    GLuint spread, finish;
    GpuBuffer box, firsts, depths, sums, layers; // see shadow.h
    int maps;                                    // there is room for
} HairShadow;

// `side`: a multiple of 8. `by_processor`: C makes the maps. `behind`: see ParticleLight.
Result hair_shadow_create(HairShadow *hair, const GpuLimits *limits, bool deep, int side,
                          bool by_processor, bool behind, Error *error);
void hair_shadow_destroy(HairShadow *hair);

// Compiles the shaders for hair that needs CAST_ bits `variant`, unless they are there.
Result hair_shadow_build(HairShadow *hair, unsigned variant, Error *error);

// Empties all maps, of which there are `maps`, and makes the shaders for such hair if they are
// needed and not there yet. RESULT_FAILED if memory is short or a shader does not compile.
Result hair_shadow_begin(HairShadow *hair, int maps, ShadowCasters casters, Error *error);

// Between begin and end.

// Of each of `count` lights, at most MAX_LIGHTS, the box (see light_frame.h) of all hair before it;
// the lowest place is above the highest if there is none. Waits for the GPU, once.
void hair_shadow_find_boxes(HairShadow *hair, const LightView *views, int count,
                            ShadowCasters casters, double (*boxes)[6]);

// Where a map of hair in `box` lies.
LightFrame hair_shadow_frame(const HairShadow *hair, const LightView *view, const double box[6]);

// Texels of such a map in a metre across, about.
float hair_shadow_scale(const LightView *view, const LightFrame *frame);

// Draws map `map`.
void hair_shadow_draw(HairShadow *hair, const LightView *view, const LightFrame *frame, int map,
                      ShadowCasters casters);

void hair_shadow_end(HairShadow *hair);

// The light at all particles of the casters, if C has found it: false where shaders look for it.
// With cpu.past_mesh the mesh's shadows are in it, too.
bool hair_shadow_lights(const HairShadow *hair, const ParticleLight **lights, uint32_t *count);

// Binds what glsl/draw/shadow.glsl reads.
void hair_shadow_bind(const HairShadow *hair);
