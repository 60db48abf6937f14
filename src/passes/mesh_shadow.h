// SPDX-License-Identifier: MIT
// How far each light sees before the mesh stands in its way: depth maps by OpenGL's rasteriser.
#pragma once

#include "draw/shadow_frames.h"
#include "passes/render_mesh.h"

typedef struct MeshShadow {
    GLuint program;
    GLuint depth, frame; // a square for each map, one below the other
    int maps;            // there is room for
    ShadowMeshKey shown; // in all maps; of a zeroed key: none
} MeshShadow;

// Room for so many maps, and their shader. RESULT_FAILED if memory is short. Destroying a zeroed
// struct is legal.
Result mesh_shadow_reserve(MeshShadow *shadow, int maps, Error *error);
void mesh_shadow_destroy(MeshShadow *shadow);

// Draws the mesh into all maps that are placed, unless they show it. Needs room for them, and
// the DrawParams and ShadowParams blocks; changes framebuffer and viewport.
void mesh_shadow_draw(MeshShadow *shadow, const ShadowFrames *frames, const RenderMesh *mesh);

void mesh_shadow_bind(const MeshShadow *shadow);
