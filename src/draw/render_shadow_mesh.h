// SPDX-License-Identifier: MIT
// How far each light sees before the mesh stands in its way: plain depth maps.
#pragma once

#include "draw/light_frame.h"
#include "draw/render_mesh.h"

typedef struct RenderShadowMesh {
    GLuint program;
    GLuint depth, frame; // a square for each map, one below the other
    int maps;            // there is room for
} RenderShadowMesh;

// The mesh where the head has carried it.
typedef struct ShadowMesh {
    const RenderMesh *mesh;
    float rotation[4], translation[3]; // m; as the DrawParams block has them
} ShadowMesh;

// A map's square, and how a point is moved before it looks at the map.
typedef struct ShadowMeshFrame {
    LightFrame frame;
    double depth_shift; // of the map's depths
    double lift;        // m, along the normal of the mesh
} ShadowMeshFrame;

enum { SHADOW_MESH_SIDE = 1024 }; // texels of a map

// Room for so many maps; nothing if there is. RESULT_FAILED if memory is short.
Result render_shadow_mesh_reserve(RenderShadowMesh *shadow, int maps, Error *error);
void render_shadow_mesh_destroy(RenderShadowMesh *shadow);

// Widens the box (see light_frame.h) to the mesh's.
void shadow_mesh_add_box(const ShadowMesh *mesh, const LightView *view, double box[6]);

// Where the mesh's map lies for what stands in `box`: before it is shadow on it, too.
ShadowMeshFrame shadow_mesh_frame(const LightView *view, const double box[6]);

// Draws map `map`, of which the ShadowParams block tells the frame. The first one empties all.
// Needs the DrawParams block; changes framebuffer and viewport.
void render_shadow_mesh_draw(const RenderShadowMesh *shadow, const RenderMesh *mesh, int map);
