// SPDX-License-Identifier: MIT
// How much of each light passes hair and mesh: a pair of maps for each light that casts shadows.
// Maps are made again only if something has changed. They are read where hair and mesh are shaded
// (glsl/draw/shadow.glsl).
#pragma once

#include "gpu/gpu_timer.h"
#include "passes/hair_shadow.h"
#include "passes/mesh_shadow.h"
#include "scene/scene.h"

// Everything that the maps depend on. Two scenes with equal bytes and the same revision have the
// same maps.
typedef struct ShadowScene {
    const Light *lights;
    uint32_t light_count;
    ShadowCasters casters;
    struct {
        const RenderMesh *mesh;            // NULL or without triangles: none
        float rotation[4], translation[3]; // m; as the DrawParams block has them
    } mesh;                                // casts shadows, too
    float middle[3];                       // m, world: the lamps' target
    uint64_t revision;                     // changes whenever positions change; 0: always differs
} ShadowScene;

typedef struct Shadows {
    ShadowOptions options;
    HairShadow hair;
    MeshShadow mesh;
    uint64_t mesh_version;
    ShadowParams params;
    ShadowKey drawn; // key of the maps
    bool any;
    uint64_t version;    // incremented when maps are made
    uint32_t maps_drawn; // number of maps drawn in the last shadows_draw
} Shadows;

void shadows_create(Shadows *shadow, const GpuLimits *limits, const ShadowOptions *options);
void shadows_destroy(Shadows *shadow);

// Makes room for this many maps of a mesh and compiles their shader. RESULT_FAILED if memory is
// short.
Result shadows_reserve_mesh(Shadows *shadow, int maps, Error *error);

// Must be called when the mesh has changed at the same place in memory.
void shadows_forget_mesh(Shadows *shadows);

// Whether the maps show this scene already.
bool shadows_show(const Shadows *shadow, const ShadowScene *scene);

// Makes the map of each light that casts shadows, unless they show this scene already. Waits for
// the GPU, changes framebuffer and viewport. Needs the DrawParams block. RESULT_FAILED if memory is
// short.
Result shadows_draw(Shadows *shadow, const ShadowScene *scene, GpuTimer *timer, Error *error);

// Binds the inputs of glsl/draw/shadow.glsl.
void shadows_bind(Shadows *shadow);
