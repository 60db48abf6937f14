// SPDX-License-Identifier: MIT
// Points that are bound to a mesh: each keeps its place relative to the nearest triangle while the
// mesh deforms, and turns with the surface there.
#pragma once

#include "mesh/mesh_turns.h"
#include "mesh/surface.h"

typedef struct BoundPoint {
    uint32_t corner[3]; // vertices of its triangle
    double weight[3];   // of the surface's point nearest to it
    double place[3];    // of that, at rest (m)
} BoundPoint;

// A rigid motion, x' = R x + translation; rotation: unit quaternion x y z w.
typedef struct RigidMotion {
    double rotation[4], translation[3];
} RigidMotion;

typedef struct MeshBinding {
    uint32_t count;
    BoundPoint *points; // [count], owned
    float median;       // m: half of the points are nearer to the surface
} MeshBinding;

// Binds `count` points to the mesh at rest. RESULT_BAD_INPUT, with `name` (the mesh's file) in
// front, if no triangle has an area; RESULT_FAILED when memory is short.
Result mesh_binding_create(MeshBinding *binding, const Mesh *rest, const char *name,
                           const float (*points)[3], uint32_t count, Error *error);
void mesh_binding_destroy(MeshBinding *binding);

// The motion from rest of the surface around point `i`, with all vertices at `position` and their
// turns (mesh_turns_find, those of its corners) in `turn`. The point itself moves along.
RigidMotion mesh_binding_motion(const MeshBinding *binding, uint32_t i, const float (*position)[3],
                                const double (*turn)[4]);

void rigid_motion_apply(const RigidMotion *motion, const double point[3], double moved[3]);
// a after b.
RigidMotion rigid_motion_product(const RigidMotion *a, const RigidMotion *b);
RigidMotion rigid_motion_inverse(const RigidMotion *motion);

// The motion that takes the points `from` to the points `to` with the least sum of squares (B.
// Horn, "Closed-form solution of absolute orientation using unit quaternions", 1987). What the
// points leave open, as where they lie on one line, is as in `near`.
RigidMotion rigid_motion_fit(const double (*from)[3], const double (*to)[3], uint32_t count,
                             const RigidMotion *near);
