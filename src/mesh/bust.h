// SPDX-License-Identifier: MIT
// Shoulders under the head of scalp.h, for hair to fall on.
#pragma once

#include "mesh/mesh.h"

// Appends a rounded cone to a mesh: a closed surface of its own, outward, with its vertices on the
// cone of the spheres about `a` and `b` with radii a[3] and b[3] (neither inside the other), in
// `rings` bands and 2 * rings sectors. Normals are computed anew. RESULT_FAILED when memory is
// short.
Result bust_append_cone(Mesh *mesh, const float a[4], const float b[4], uint32_t rings,
                        Error *error);

// Appends neck, shoulders, upper arms and chest, which overlap each other and the head's neck.
Result bust_append_shoulders(Mesh *mesh, Error *error);
