// SPDX-License-Identifier: MIT
// The signed distance to a mesh that deforms, on a grid that stays fixed in the head's frame. The
// CPU computes the grid again for each step in which the mesh has changed where hair can touch it.
//
// Distances are exact at grid points within one spacing of the surface. From there, each point
// takes the nearest of its neighbours' nearest triangles; inside the mesh this goes on to its
// middle, outside as far as colliders need. The sign is found as in distance_field.h.
#pragma once

#include "sim/bound.h"
#include "sim/distance_field.h"

typedef struct MovingField {
    DistanceField field; // four floats a point: distance (m), and the displacement of the nearest
                         // surface point in the step (m, in the head's frame)
    const Mesh *mesh;    // its triangles are used
    float outside;       // m: distances outside the mesh are clamped to this
    struct MovingFieldWork *work;
    bool made;
    uint64_t builds; // number of times that distances were computed
} MovingField;

// Creates a grid that covers the body at all times, as far as strands of at most `longest` m can
// reach, with `resolution` spacings along its longest side. `outside` (m): the largest distance
// that colliders need. RESULT_FAILED if the driver allows no buffer of that size or memory is
// short. A zeroed field may be destroyed.
Result moving_field_create(MovingField *field, const Gpu *gpu, const Body *body, float longest,
                           float outside, uint32_t resolution, Error *error);
void moving_field_destroy(MovingField *field);

// Computes the field for a step in which the mesh moves from `before` to `after` (positions of all
// vertices in the head's frame). Positions are rounded to 1/64 of a spacing. If none differs from
// those of the last computation, distances are kept, so a mesh that only moves with the head costs
// nothing.
void moving_field_update(MovingField *field, const float (*before)[3], const float (*after)[3]);
