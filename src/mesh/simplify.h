// SPDX-License-Identifier: MIT
// Reduces the number of triangles of a mesh.
#pragma once

#include "base/double3.h"
#include "mesh/mesh.h"

// Collapses edges, in the order of least change of the surface, until `triangle_count` triangles
// are left or no edge can be collapsed without a fold or a hole (Garland and Heckbert 1997,
// "Surface simplification using quadric error metrics"). `weight` is a factor of squared distances
// that depends on the place; NULL: 1 everywhere. The mesh must be closed and have no texture
// coordinates; its normals are not changed. Deterministic. RESULT_FAILED when memory is short.
Result simplify_mesh(Mesh *mesh, uint32_t triangle_count, double (*weight)(const Double3 at),
                     Error *error);
