// SPDX-License-Identifier: MIT
// What the passes that compute a distance field are given (distance_field.c).
#include "common/shared.h"

UNIFORM_BLOCK(FieldParams, field_params, BIND_STEP)
{
    vec4 low; // grid point 0 0 0, m; distance between grid points
    uint size_x;
    uint size_y;
    uint size_z;
    uint count;  // of work items
    uint phase;  // field_near: 0 distances, 1 triangles
    uint stride; // field_flood: grid points between neighbours
    uint axis;   // field_cross, field_sign
}
END_BLOCK(FieldParams, field_params);

// Side of the block of grid points, and of the square of columns, that a work item is.
#define FIELD_BLOCK   4
#define FIELD_COLUMNS 8
