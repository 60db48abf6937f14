// SPDX-License-Identifier: MIT
// The opaque mesh behind and among the hair.
#pragma once

#include "base/params.h"
#include "gpu/shader.h"
#include "mesh/mesh.h"
#include "passes/render_target.h"

typedef struct RenderMesh {
    GLuint surface, edges; // programs
    GLuint vertex_array;
    GpuBuffer position, normal, triangle; // float[3], float[3], uint[3]
    GpuBuffer open;                       // float, see openness.h; none: 1 everywhere
    GpuBuffer tint;                       // float[3], see scalp_tint.h; none: 1 everywhere
    uint32_t triangle_count;              // 0: no mesh, nothing is done
    float low[3], high[3];                // bounds in the head's frame, m
} RenderMesh;

// Uploads the mesh. RESULT_FAILED if memory is short.
Result render_mesh_create(RenderMesh *mesh, const Mesh *source, const GpuLimits *limits,
                          Error *error);

// Moves the vertices. `moved` has the number of vertices that the mesh was made with, in the head's
// frame, and unit normals.
void render_mesh_move(RenderMesh *mesh, const Mesh *moved);

// Uploads each vertex's share of the sky (openness.h). RESULT_FAILED if memory is short.
Result render_mesh_set_openness(RenderMesh *mesh, const float (*open)[2], uint32_t vertex_count,
                                const GpuLimits *limits, Error *error);

// Uploads each vertex's factors of the mesh's colour (scalp_tint.h). Errors as above.
Result render_mesh_set_tint(RenderMesh *mesh, const float (*tint)[3], uint32_t vertex_count,
                            const GpuLimits *limits, Error *error);

void render_mesh_destroy(RenderMesh *mesh);

// Draws the mesh into the target's depth, its surface (valid where there is depth) and its edges.
// Needs the DrawParams block, cleared depths, and depth test and depth writes on.
void render_mesh_draw(const RenderMesh *mesh, const RenderTarget *target);
