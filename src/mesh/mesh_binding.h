// SPDX-License-Identifier: MIT
// Points bound to a mesh: each keeps its position relative to the nearest triangle while the mesh
// deforms, and rotates with the surface there.
#pragma once

#include "mesh/mesh_turns.h"
#include "mesh/surface.h"

typedef struct BoundPoint {
    uint32_t corner[3]; // vertices of its triangle
    double weight[3];   // of the nearest point of the surface
    double place[3];    // position relative to that point, at rest (m)
} BoundPoint;

// A rigid motion, x' = R x + translation; rotation: unit quaternion x y z w.
typedef struct RigidMotion {
    double rotation[4], translation[3];
} RigidMotion;

typedef struct MeshBinding {
    uint32_t count;
    BoundPoint *points; // [count], owned
    float median;       // m, median distance of the points from the surface
} MeshBinding;

// Binds `count` points to the mesh at rest. RESULT_BAD_INPUT, prefixed with `name` (the mesh's
// file), if no triangle has an area; RESULT_FAILED when memory is short.
Result mesh_binding_create(MeshBinding *binding, const Mesh *rest, const char *name,
                           const float (*points)[3], uint32_t count, Error *error);
void mesh_binding_destroy(MeshBinding *binding);

// The motion of the surface around point `i` from rest, given the positions of all vertices and the
// rotations of those at its corners (mesh_turns_find) in `turn`. The point itself moves with it.
RigidMotion mesh_binding_motion(const MeshBinding *binding, uint32_t i, const float (*position)[3],
                                const double (*turn)[4]);

void rigid_motion_apply(const RigidMotion *motion, const double point[3], double moved[3]);
// The motion b followed by a.
RigidMotion rigid_motion_product(const RigidMotion *a, const RigidMotion *b);
RigidMotion rigid_motion_inverse(const RigidMotion *motion);

// The motion from the points `from` to the points `to` with the least sum of squares (B. Horn,
// "Closed-form solution of absolute orientation using unit quaternions", 1987). What the points do
// not determine, for instance if they lie on a line, is taken from `near`.
RigidMotion rigid_motion_fit(const double (*from)[3], const double (*to)[3], uint32_t count,
                             const RigidMotion *near);
