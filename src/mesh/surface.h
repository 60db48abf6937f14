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
    uint32_t flat_count; // triangles without an area, which are passed over
    double area;         // of all together, m2
    SurfaceNode *nodes;  // a tree of boxes
    // Not of unit length: of the edge behind each corner, [mesh's triangles], and of the vertices,
    // weighted by angle, [mesh's vertices].
    double (*edge_normal)[3][3];
    double (*corner_normal)[3];
} Surface;

typedef struct SurfacePoint {
    uint32_t triangle; // of the mesh
    Double3 weight;    // of its corners, sum 1
    Double3 place;
} SurfacePoint;

// RESULT_BAD_INPUT, with `name` (the file's) in front, if no triangle has an area; RESULT_FAILED
// when memory is short. The mesh outlives the surface.
Result surface_create(Surface *surface, const Mesh *mesh, const char *name, Error *error);
void surface_destroy(Surface *surface);

// Twice the area of a triangle of the mesh, and its unit normal ({0, 0, 0} where that is 0).
double surface_triangle(const Mesh *mesh, uint32_t triangle, Double3 normal);

// The point of a triangle with these weights.
SurfacePoint surface_at(const Surface *surface, uint32_t triangle, const Double3 weight);

// The vertices' normals at a point; unit length.
void surface_normal(const Surface *surface, const SurfacePoint *point, Double3 normal);

// Texture coordinate at a point; false if a corner of its triangle has none.
bool surface_uv(const Surface *surface, const SurfacePoint *point, double uv[2]);

// The directions in which u and v grow there, of unit length; false if texture coordinates say
// none.
bool surface_uv_axes(const Surface *surface, const SurfacePoint *point, Double3 u, Double3 v);

// The surface's point nearest to `from`; returns how far it is, negative inside, as the normal of
// the face, edge or corner there says (Baerentzen and Aanaes 2005, "Signed distance computation
// using the angle weighted pseudonormal"), which is right wherever the surface is closed and does
// not cross itself. A triangle in *nearest that is near makes it quicker: it holds one of the
// mesh's.
double surface_nearest(const Surface *surface, const Double3 from, SurfacePoint *nearest);
