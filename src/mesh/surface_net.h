// SPDX-License-Identifier: MIT
// The mesh of a surface, from its signed distance on a grid.
#pragma once

#include "base/double3.h"
#include "mesh/mesh.h"

typedef struct SurfaceNet {
    double (*distance)(const Double3 at); // negative inside; gradient of about 1
    // The same distance, and the outward unit normal unless it is NULL. `own` is the net's: what is
    // known about the last point's neighbourhood may be kept there.
    double (*near)(void *own, const Double3 at, Double3 normal);
    void *own;
    double *line[3];   // positions of the grid's planes along each axis, m, increasing
    uint32_t count[3]; // at least 2; the outermost points must be outside
    int smoothing;     // rounds in which vertices move to the mean of their neighbours
} SurfaceNet;

// Makes a closed mesh with a vertex in each cell that the surface crosses and two triangles for
// each crossed edge of the grid (Gibson 1998, "Constrained elastic surface nets"). Vertices are on
// the surface, up to rounding; their normals are left to the caller. RESULT_FAILED when memory is
// short.
Result surface_net_make(Mesh *mesh, const SurfaceNet *net, Error *error);

// Moves a point near the surface onto it, along the normal.
void surface_net_project(const SurfaceNet *net, Double3 place);
