// SPDX-License-Identifier: MIT
// The signed distance to a mesh that deforms, on a grid that stays in the head's frame: made anew
// by the processor for each step in which the mesh has changed where hair can touch it.
//
// Distances are exact for grid points within a spacing of the surface; from there on each point
// takes the triangle of its neighbours that is nearest to it, inside to the middle of the mesh,
// outside as far as colliders ask. Inside is where distance_field.h finds it.
#pragma once

#include "sim/bound.h"
#include "sim/distance_field.h"

typedef struct MovingField {
    DistanceField field; // four floats a point: distance (m), and how far the surface that is
                         // nearest has come in the step (m, in the head's frame)
    const Mesh *mesh;    // its triangles
    float outside;       // m: the largest distance kept outside the mesh; farther points have it
    struct MovingFieldWork *work;
    bool made;
    uint64_t builds; // how often distances were computed
} MovingField;

// A grid for the body at all its times, where strands of at most `longest` m can be, with
// `resolution` spacings along its longest side; `outside` (m): what colliders ask for.
// RESULT_FAILED if the driver allows no buffer of that size or memory is short. A zeroed field may
// be destroyed.
Result moving_field_create(MovingField *field, const Gpu *gpu, const Body *body, float longest,
                           float outside, uint32_t resolution, Error *error);
void moving_field_destroy(MovingField *field);

// Makes the field that of the mesh at `after`, which has come there from `before` (positions of all
// vertices in the head's frame). Vertices count by 1/64 of a spacing: if none has changed by that,
// distances stay, so that a mesh that moves with the head costs nothing.
void moving_field_update(MovingField *field, const float (*before)[3], const float (*after)[3]);
