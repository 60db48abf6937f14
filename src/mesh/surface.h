// SPDX-License-Identifier: MIT
// A mesh as a surface that can be asked: where its points are, how they lie, how far away it is.
#pragma once

#include "base/double3.h"
#include "mesh/mesh.h"

#include <stdbool.h>

typedef struct SurfaceNode SurfaceNode;

typedef struct Surface {
    const Mesh *mesh;   // not owned
    uint32_t *triangle; // [triangle_count], those with an area, in the tree's order
    uint32_t triangle_count;
    uint32_t flat_count; // triangles without an area, which are skipped
    double area;         // m2, of all triangles
    SurfaceNode *nodes;  // a tree of bounding boxes
    // Not of unit length: normals of the edge after each corner, [mesh's triangles], and of the
    // vertices, weighted by angle, [mesh's vertices].
    double (*edge_normal)[3][3];
    double (*corner_normal)[3];
} Surface;

typedef struct SurfacePoint {
    uint32_t triangle; // index in the mesh
    Double3 weight;    // of its corners, with sum 1
    Double3 place;
} SurfacePoint;

// RESULT_BAD_INPUT, prefixed with `name` (the mesh's file), if no triangle has an area;
// RESULT_FAILED when memory is short. The mesh must outlive the surface.
Result surface_create(Surface *surface, const Mesh *mesh, const char *name, Error *error);
void surface_destroy(Surface *surface);

// Returns twice the area of a triangle of the mesh and sets its unit normal ({0, 0, 0} if the area
// is 0).
double surface_triangle(const Mesh *mesh, uint32_t triangle, Double3 normal);

// The point of a triangle with these weights.
SurfacePoint surface_at(const Surface *surface, uint32_t triangle, const Double3 weight);

// The interpolated unit normal of the vertices at a point.
void surface_normal(const Surface *surface, const SurfacePoint *point, Double3 normal);

// Texture coordinates at a point; false if a corner of its triangle has none.
bool surface_uv(const Surface *surface, const SurfacePoint *point, double uv[2]);

// The unit directions in which u and v increase; false if texture coordinates do not define them.
bool surface_uv_axes(const Surface *surface, const SurfacePoint *point, Double3 u, Double3 v);

// The nearest point of the surface to `from`; returns its signed distance, negative inside. The
// sign comes from the normal of the face, edge or corner (Baerentzen and Aanaes 2005, "Signed
// distance computation using the angle weighted pseudonormal"), which is correct wherever the
// surface is closed and does not intersect itself. On input, *nearest must hold a triangle of the
// mesh; a near one speeds up the search.
double surface_nearest(const Surface *surface, const Double3 from, SurfacePoint *nearest);
