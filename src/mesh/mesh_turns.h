// SPDX-License-Identifier: MIT
// The rotation of a deforming mesh at each vertex, computed from the ring of vertices around it. It
// does not depend on the order of vertices or on how polygons are split into triangles.
#pragma once

#include "mesh/mesh.h"

// Computed from the mesh at rest. A zeroed struct may be destroyed.
typedef struct MeshTurns {
    uint32_t vertex_count;
    uint32_t *first;       // [vertex_count + 1], start of a vertex's ring in the next two arrays
    uint32_t *neighbour;   // vertices of the rings
    double (*share)[2];    // weights of their offsets in the two tangents
    double (*frame)[3][3]; // [vertex_count], two tangents and the normal at rest; 0 without a ring
    uint32_t *twin;        // [vertex_count], the first vertex at the same position, which has the
                           // same rotation
} MeshTurns;

// RESULT_BAD_INPUT beyond 2^29 triangles or 2^30 vertices, RESULT_FAILED when memory is short.
Result mesh_turns_create(MeshTurns *turns, const Mesh *rest, Error *error);
void mesh_turns_destroy(MeshTurns *turns);

// The rotation at `vertex` from rest to the given positions of all vertices: a unit quaternion x y
// z w. The least-squares linear map of the ring is split into a stretch within its plane and a
// rotation (polar decomposition, in closed form). So a sheared sheet turns by half the shear's
// angle, atan(shear/2). The identity if the ring has collapsed.
void mesh_turns_find(const MeshTurns *turns, uint32_t vertex, const float (*position)[3],
                     double turn[4]);
