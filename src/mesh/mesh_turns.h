// SPDX-License-Identifier: MIT
// How a deforming mesh turns at each of its vertices: the rotation of the ring of vertices around
// it. It does not depend on the order of vertices or on how polygons are cut into triangles.
#pragma once

#include "mesh/mesh.h"

// Made from the mesh at rest. A zeroed one may be destroyed.
typedef struct MeshTurns {
    uint32_t vertex_count;
    uint32_t *first;       // [vertex_count + 1]: where a vertex's ring begins in the next two
    uint32_t *neighbour;   // vertices
    double (*share)[2];    // what of their offset goes into each of the two tangents
    double (*frame)[3][3]; // [vertex_count], at rest: two tangents and the normal; 0: no ring
    uint32_t *twin;        // [vertex_count]: the first vertex at the same place, whose turn it has
} MeshTurns;

// RESULT_BAD_INPUT beyond 2^29 triangles or 2^30 vertices, RESULT_FAILED when memory is short.
Result mesh_turns_create(MeshTurns *turns, const Mesh *rest, Error *error);
void mesh_turns_destroy(MeshTurns *turns);

// The rotation at `vertex` from rest to these positions of all vertices: a unit quaternion x y z w.
// The ring's linear map, by least squares, is split into a stretch within its plane and a rotation
// (polar decomposition, in closed form), so that a sheared sheet turns by half the shear's angle,
// atan(shear/2). None where the ring has collapsed.
void mesh_turns_find(const MeshTurns *turns, uint32_t vertex, const float (*position)[3],
                     double turn[4]);
