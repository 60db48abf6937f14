// SPDX-License-Identifier: MIT
// Shadow maps: what of each light hair and mesh let through. Made in compute, for either
// rasteriser; read where hair and mesh are shaded (glsl/shadow.glsl).
//
// A deep opacity map has for each texel the depth at which hair begins and the optical depth of the
// layers behind. An approximated one has the first depth only.
#pragma once

#include "gpu_timer.h"
#include "hair.h"
#include "render_mesh.h"
#include "scene.h"
#include "shader.h"

#include "shadow.h"

typedef struct ShadowOptions {
    Shadow kind;   // not none
    int side;      // texels across a map, rounded up to a multiple of 8
    float spacing; // approx: between fibres along the light, in radii
} ShadowOptions;

// Hair that stands in the light.
typedef struct ShadowCaster {
    const HairBatch *batch;
    float radius; // m, at the root
    float tip_ratio, opacity;
} ShadowCaster;

// What the maps are made of. Two scenes of equal bytes and of the same revision have the same maps.
typedef struct ShadowScene {
    const Light *lights;
    uint32_t light_count;
    const ShadowCaster *casters;
    uint32_t caster_count;
    const RenderMesh *mesh;                      // stands in the light, too, if it has triangles
    float head_rotation[4], head_translation[3]; // of the mesh, as the DrawParams block has it
    float middle[3];                             // m, world: what a lamp looks at
    uint64_t revision; // another one wherever positions differ; 0: never the same
} ShadowScene;

typedef struct RenderShadow {
    ShadowOptions options;
    const GpuLimits *limits;
    GLuint bounds, first, spread, splat, finish, mesh; // programs
    GpuBuffer boxes, firsts, depths, sums, layers;     // see shadow.h
    GpuBuffer cast_uniforms, uniforms;
    GLuint mesh_depth, mesh_frame; // a square for each map, one below the other
    int maps;                      // there is room for
    ShadowParams params;
    ShadowScene drawn; // what the maps show; pointers are not followed
    Light lights[SCENE_MAX_LIGHTS];
    bool any;
    uint32_t maps_drawn; // in the last render_shadow_draw
} RenderShadow;

Result render_shadow_create(RenderShadow *shadow, const GpuLimits *limits,
                            const ShadowOptions *options, Error *error);
void render_shadow_destroy(RenderShadow *shadow);

// Makes the map of each light that casts shadows, unless they show this scene already. Waits for
// the GPU, changes framebuffer and viewport. Needs the DrawParams block. RESULT_FAILED if memory is
// short.
Result render_shadow_draw(RenderShadow *shadow, const ShadowScene *scene, GpuTimer *timer,
                          Error *error);

// Binds what glsl/shadow.glsl reads.
void render_shadow_bind(RenderShadow *shadow);
