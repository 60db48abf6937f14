// SPDX-License-Identifier: MIT
// The normals of a surface's edges and corners, by which surface_nearest tells inside from outside.
#pragma once

#include "mesh/surface.h"

// Fills edge_normal and corner_normal, which hold zeros, from the mesh and the triangles with an
// area. Vertices that lie in one place count as one. An edge has the sum of the normals of its
// triangles, a corner that of its triangles by their angles there (Baerentzen and Aanaes 2005).
// False when memory is short.
bool surface_compute_normals(Surface *surface);
