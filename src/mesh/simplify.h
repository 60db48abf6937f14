// SPDX-License-Identifier: MIT
// A mesh of fewer triangles.
#pragma once

#include "base/double3.h"
#include "mesh/mesh.h"

// Merges the ends of edges, those first that change the surface least, until `triangle_count` are
// left or none can be merged without a fold or a hole (Garland and Heckbert 1997, "Surface
// simplification using quadric error metrics"). `weight` says how much a change counts at a place,
// squared distances being multiplied by it; NULL: 1 everywhere. Takes a closed mesh without texture
// coordinates; computes normals anew. Equal meshes give equal ones. RESULT_FAILED when memory is
// short.
Result simplify_mesh(Mesh *mesh, uint32_t triangle_count, double (*weight)(const Double3 at),
                     Error *error);
