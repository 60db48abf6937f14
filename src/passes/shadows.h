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
    } mesh;                                // stands in the light, too
    float middle[3];                       // m, world: what a lamp looks at
    uint64_t revision; // another one wherever positions differ; 0: never the same
} ShadowScene;

typedef struct Shadows {
    ShadowOptions options;
    HairShadow hair;
    MeshShadow mesh;
    uint64_t mesh_version;
    ShadowParams params;
    ShadowKey drawn; // what the maps show
    bool any;
    uint64_t version;    // counts the times that they were made
    uint32_t maps_drawn; // in the last shadows_draw
} Shadows;

void shadows_create(Shadows *shadow, const GpuLimits *limits, const ShadowOptions *options);
void shadows_destroy(Shadows *shadow);

// Makes room for so many maps of a mesh, and their shader. RESULT_FAILED if memory is short.
Result shadows_reserve_mesh(Shadows *shadow, int maps, Error *error);

// The mesh has changed, at the same place in memory.
void shadows_forget_mesh(Shadows *shadows);

// Whether the maps show this scene already.
bool shadows_show(const Shadows *shadow, const ShadowScene *scene);

// Makes the map of each light that casts shadows, unless they show this scene already. Waits for
// the GPU, changes framebuffer and viewport. Needs the DrawParams block. RESULT_FAILED if memory is
// short.
Result shadows_draw(Shadows *shadow, const ShadowScene *scene, GpuTimer *timer, Error *error);

// Binds what glsl/draw/shadow.glsl reads.
void shadows_bind(Shadows *shadow);
