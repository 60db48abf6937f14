// SPDX-License-Identifier: MIT
// What of each light hair and mesh let through: a pair of maps for each light that casts shadows,
// made anew when something has changed, and read where hair and mesh are shaded
// (glsl/draw/shadow.glsl).
#pragma once

#include "draw/render_mesh.h"
#include "gpu/gpu_timer.h"
#include "passes/hair_shadow.h"
#include "scene/scene.h"

// The mesh where the head has carried it.
typedef struct ShadowMesh {
    const RenderMesh *mesh;
    float rotation[4], translation[3]; // m; as the DrawParams block has them
} ShadowMesh;

// How far each light sees before the mesh stands in its way: plain depth maps.
typedef struct MeshShadow {
    GLuint program;
    GLuint depth, frame;     // a square for each map, one below the other
    GpuBuffer texels;        // with_texels: the same, floats, row by row
    int maps;                // there is room for
    ShadowMesh shown;        // in all maps; mesh NULL: none
    mat4 frames[MAX_LIGHTS]; // its maps'
    int shown_maps;
} MeshShadow;

typedef struct ShadowOptions {
    Shadow kind;   // not none
    int side;      // texels across a map of hair, rounded up to a multiple of 8
    float spacing; // approx: between fibres along the light, in radii
    bool copies;   // by the processor: of buffers that it cannot share with the GPU
    bool behind;   // dom by the processor: also count the fibres behind each point (look.h)
} ShadowOptions;

// What the maps are made of. Two scenes of equal bytes and of the same revision have the same maps.
typedef struct ShadowScene {
    const Light *lights;
    uint32_t light_count;
    ShadowCasters casters;
    ShadowMesh mesh;   // stands in the light, too, if there is one with triangles
    float middle[3];   // m, world: what a lamp looks at
    uint64_t revision; // another one wherever positions differ; 0: never the same
} ShadowScene;

typedef struct Shadows {
    ShadowOptions options;
    bool with_texels; // the mesh's maps are copied to a buffer
    HairShadow hair;
    MeshShadow mesh;
    ShadowParams params;
    ShadowScene drawn; // what the maps show; pointers are not followed
    Light lights[SCENE_MAX_LIGHTS];
    ShadowCaster *casters; // [caster_room], owned
    uint32_t caster_room;
    bool any;
    uint64_t version;    // counts the times that they were made
    uint32_t maps_drawn; // in the last shadows_draw
} Shadows;

// `by_processor`: C makes the maps, for CPU drivers, which share its memory.
Result shadows_create(Shadows *shadow, const GpuLimits *limits, const ShadowOptions *options,
                      bool by_processor, Error *error);
void shadows_destroy(Shadows *shadow);

// Room for so many maps of a mesh, and their shader. RESULT_FAILED if memory is short.
Result shadows_reserve_mesh(Shadows *shadow, int maps, Error *error);

// The mesh is another one, at the same place in memory.
void shadows_forget_mesh(Shadows *shadows);

// Whether the maps show this scene already.
bool shadows_show(const Shadows *shadow, const ShadowScene *scene);

// Makes the map of each light that casts shadows, unless they show this scene already. Waits for
// the GPU, changes framebuffer and viewport. Needs the DrawParams block. RESULT_FAILED if memory is
// short.
Result shadows_draw(Shadows *shadow, const ShadowScene *scene, GpuTimer *timer, Error *error);

// Binds what glsl/draw/shadow.glsl reads; the mesh's maps as a texture and, if there is one, as a
// buffer.
void shadows_bind(Shadows *shadow);
