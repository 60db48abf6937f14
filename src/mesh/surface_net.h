// SPDX-License-Identifier: MIT
// A surface's mesh, from its signed distance on a grid.
#pragma once

#include "base/double3.h"
#include "mesh/mesh.h"

typedef struct SurfaceNet {
    double (*distance)(const Double3 at); // negative inside; slopes of about 1
    void (*normal)(const Double3 at, Double3 normal);
    double *line[3];   // where the grid's planes stand along each axis, m, increasing
    uint32_t count[3]; // of them, at least 2; outside at all points of the outermost
    int smoothing;     // rounds in which vertices move to the middle of their neighbours
} SurfaceNet;

// A closed mesh with a vertex in each cell that the surface crosses and two triangles for each edge
// (Gibson 1998, "Constrained elastic surface nets"). Vertices lie on the surface to rounding.
// RESULT_FAILED when memory is short.
Result surface_net_make(Mesh *mesh, const SurfaceNet *net, Error *error);

// Moves a place that is near the surface onto it, along the normal.
void surface_net_project(const SurfaceNet *net, Double3 place);
