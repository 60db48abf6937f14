// SPDX-License-Identifier: MIT
// A body of the scene in motion: its head, its mesh if that deforms, and the distances to the mesh
// that its hair collides with.
#pragma once

#include "scene/scene.h"
#include "scene/schedule.h"
#include "sim/bound.h"
#include "sim/carry.h"
#include "sim/distance_field.h"
#include "sim/moving_field.h"

// A zeroed struct may be destroyed.
typedef struct MovingBody {
    const SceneBody *of;
    Carry carry;            // made if the head moves or the mesh deforms
    BoundBody mesh;         // empty unless the mesh deforms
    DistanceField field;    // of the mesh that hair collides with; empty if it deforms
    MovingField moving;     // of the mesh that hair collides with, if it deforms
    uint32_t mesh_checksum; // CRC-32 of that mesh's vertices and triangles
    HeadPose head;          // in the drawn frame
    HeadPose step_head, step_head_before; // after the last step and before it
    HeadPose posed_at;                    // at the last pose
    double posed_shape;                   // the mesh at the last pose (bound_body_shape)
    float middle[3]; // m: the middle of the roots in the head's frame (--wind-shelter)
} MovingBody;

// Places body `index` of the scene as at time 0. `strands`: of all sections. `mesh`: what hair
// collides with unless the scene says otherwise; NULL or empty: nothing. RESULT_FAILED when memory
// is short, errors of distance_field_create and carry_create. `scene` must outlive the body.
Result moving_body_create(MovingBody *body, const Gpu *gpu, const Scene *scene, uint32_t index,
                          const Strands *strands, const Mesh *mesh, Error *error);
void moving_body_destroy(MovingBody *body);

// Prepares for a head that moves although the scene does not say so. Errors of carry_create.
Result moving_body_expect_motion(MovingBody *body, const Gpu *gpu, Error *error);

// The field that hair collides with; NULL: none.
const DistanceField *moving_body_field(const MovingBody *body);

// Updates the field of a mesh that deforms, for a step between two times (s). Other fields do not
// change.
void moving_body_update_field(MovingBody *body, double before, double after);
