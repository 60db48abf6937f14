// SPDX-License-Identifier: MIT
// The opaque mesh that is drawn with the hair, in the CPU's memory.
#pragma once

#include "mesh/mesh.h"

// A zeroed struct is no mesh.
typedef struct DrawnMesh {
    Mesh mesh;             // owned: positions, normals and triangles, in the head's frame, m
    float (*open)[2];      // [vertices], owned: shares of the sky, see openness.h; NULL: 1
    float (*tint)[3];      // [vertices], owned: factors of the colour, see scalp_tint.h; NULL: 1
    float color[3];        // linear RGB
    float low[3], high[3]; // bounds in the head's frame, m
    uint64_t version;      // changes whenever any of this changes
} DrawnMesh;

// Copies the mesh. RESULT_FAILED if memory is short.
Result drawn_mesh_set(DrawnMesh *drawn, const Mesh *mesh, const float color[3], Error *error);

// Moves the vertices: `moved` has the same number of vertices, and normals. Openness and tint do
// not change.
void drawn_mesh_move(DrawnMesh *drawn, const Mesh *moved);

// Copies the openness of the vertices (openness.h).
Result drawn_mesh_set_openness(DrawnMesh *drawn, const float (*open)[2], Error *error);

// Copies the tint of the vertices (scalp_tint.h).
Result drawn_mesh_set_tint(DrawnMesh *drawn, const float (*tint)[3], Error *error);

void drawn_mesh_destroy(DrawnMesh *drawn);
