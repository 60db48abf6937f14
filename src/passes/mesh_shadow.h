// SPDX-License-Identifier: MIT
// Depth maps of the mesh as each light sees it, drawn by OpenGL's rasteriser.
#pragma once

#include "draw/shadow_frames.h"
#include "passes/render_mesh.h"

typedef struct MeshShadow {
    GLuint program;
    GLuint depth, frame; // a square for each map, one below the other
    int maps;            // number that the textures have room for
    ShadowMeshKey shown; // key of all maps; zeroed: none
} MeshShadow;

// Makes room for this many maps and compiles their shader. RESULT_FAILED if memory is short. A
// zeroed struct may be destroyed.
Result mesh_shadow_reserve(MeshShadow *shadow, int maps, Error *error);
void mesh_shadow_destroy(MeshShadow *shadow);

// Draws the mesh into all placed maps, unless they show it already. Needs mesh_shadow_reserve and
// the DrawParams and ShadowParams blocks. Changes framebuffer and viewport.
void mesh_shadow_draw(MeshShadow *shadow, const ShadowFrames *frames, const RenderMesh *mesh);

void mesh_shadow_bind(const MeshShadow *shadow);
