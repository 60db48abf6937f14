// SPDX-License-Identifier: MIT
// The place of a scene's shadow maps: which lights have one, the window of each, and a key of
// everything that the maps depend on, so that they are kept while it does not change. Needs no
// OpenGL; both backends use it.
#pragma once

#include "base/params.h"
#include "draw/light_frame.h"

#include "glsl/draw/material.h"
#include "glsl/draw/shadow.h"

typedef struct ShadowOptions {
    Shadow kind;   // must not be none
    int side;      // texels across a map of hair, rounded up to a multiple of 8
    float spacing; // approx: distance between fibres along the light, in radii
    int strands;   // lanes: number of strands that represent all in maps, at least; 0: all
} ShadowOptions;

// A mesh, placed by the head's motion in this frame. Zeroed: no mesh.
typedef struct ShadowMesh {
    uint64_t version;                  // differs between meshes; 0: no mesh
    float low[3], high[3];             // its box in its own frame, m
    float rotation[4], translation[3]; // to the world; m
} ShadowMesh;

// Everything that maps depend on. Equal keys whose revision is not 0 have equal maps.
typedef struct ShadowKey {
    Light lights[SCENE_MAX_LIGHTS];
    uint32_t light_count;
    uint64_t revision; // of the positions of hair: changes whenever they change
    uint64_t hair;     // a hash of the looks of all batches
    ShadowMesh mesh;
} ShadowKey;

// Everything that the maps of a mesh depend on: they are kept if only hair moves.
typedef struct ShadowMeshKey {
    ShadowMesh mesh;
    int maps;
    mat4 frames[MAX_LIGHTS];
} ShadowMeshKey;

typedef struct ShadowFrames {
    ShadowKey key;
    // The lights that cast shadows.
    LightView views[SCENE_MAX_LIGHTS];
    int lights[SCENE_MAX_LIGHTS], count;
    double particles, radius, opacity; // sums over all hair: the number of particles, their radii
                                       // and their opacities
    // Upper bounds of what all segments together add to a texel. `plain`: hair that has the width
    // of its material; `plain_width`: the same, with each segment multiplied by its diameter (m);
    // `painted`: hair with other widths.
    double plain, plain_width, painted;
    // Set by shadow_frames_place.
    ShadowParams params;
    CastParams casts[MAX_LIGHTS]; // how hair is drawn into each map
} ShadowFrames;

// Begins a scene with the views of the lights that cast shadows. Lamps look at `middle` (m, world).
// `mesh` may be zeroed.
void shadow_frames_begin(ShadowFrames *frames, const Light *lights, uint32_t light_count,
                         const float middle[3], const ShadowMesh *mesh, uint64_t revision);

// Adds a batch of hair that casts shadows; call it for each before shadow_frames_place. `batch`
// identifies the batch; the material is complete (look_material). `painted`: its width differs from
// the material's.
void shadow_frames_add(ShadowFrames *frames, const void *batch, const MaterialParams *material,
                       bool painted);

// Whether maps with the key `drawn` fit this scene. Call it after all hair has been added.
bool shadow_frames_same(const ShadowFrames *frames, const ShadowKey *drawn);

// Parameters for finding the hair's box as casting light i sees it.
CastParams shadow_frames_box(const ShadowFrames *frames, int i);

// Places the map of each casting light, `side` x `side` texels around boxes[i] (lowest u, v and
// depth, then the highest, as in LightView; empty if the lowest exceeds the highest), and the map
// of the mesh. A light that sees neither hair nor mesh has no map. `spacing`: see ShadowOptions.
void shadow_frames_place(ShadowFrames *frames, int side, float spacing, double (*boxes)[6]);

// The key of the mesh's maps at their present places.
ShadowMeshKey shadow_frames_mesh_key(const ShadowFrames *frames);

enum { SHADOW_MESH_SIDE = 1024 }; // texels of a map of the mesh
