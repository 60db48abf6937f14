// SPDX-License-Identifier: MIT
// Rasterises the triangles of a mesh by OpenGL's rules: a sample on an edge that two triangles
// share belongs to exactly one of them (coordinates are in steps of 1/256 px and edges are whole
// numbers), the nearest sample stays, and of equal depths that of the first triangle. Triangles are
// seen from both sides. Threads take bands of rows; the bits are the same for any number of
// threads.
#pragma once

#include "base/error.h"

#include <stddef.h>
#include <stdint.h>

// A mesh at its place in one frame.
typedef struct PlacedMesh {
    const float (*position)[3];    // [vertex_count], m, the mesh's frame
    const float (*normal)[3];      // [vertex_count], unit; NULL if only depths are drawn
    const float (*open)[2];        // [vertex_count], shares of the sky (openness.h); NULL: 1
    const float (*tint)[3];        // [vertex_count], factors of the colour; NULL: 1
    const uint32_t (*triangle)[3]; // [triangle_count]
    uint32_t vertex_count, triangle_count;
    float rotation[4], translation[3]; // quaternion x y z w, m: the mesh's frame -> world
} PlacedMesh;

// Vertices on the screen, kept only as memory for the next call. A zeroed struct is empty.
typedef struct MeshRaster {
    int (*place)[2];   // [room], owned: 1/256 px
    float *value[9];   // [room], owned: depth, 1 over w, normal over w, tint over w
    unsigned char *on; // [room], owned: bits of the view box's planes that the vertex is outside of
    size_t room;
} MeshRaster;

void mesh_raster_destroy(MeshRaster *raster);

// Writes the depth of the mesh, 0..1, at each texel's middle; 1: nothing. depths[side][side], side
// a multiple of 16. `rows`: of the matrix that turns (x, y, z, 1) of the world into (u w, v w,
// depth w, w), with u and v in texels. Parts of the mesh whose depth is not between 0 and 1 are cut
// off. RESULT_FAILED if memory is short.
Result mesh_raster_depths(MeshRaster *raster, const PlacedMesh *mesh, const float rows[4][4],
                          int side, float *depths, int parts, Error *error);

enum {
    MESH_EDGES = 4
}; // samples of depth beside a pixel's middle, where OpenGL's CPU driver has
   // its own

// The mesh's nearest surface in a window. A zeroed struct is empty.
typedef struct MeshSurface {
    int width, height, pitch; // px, of rows in memory: a multiple of 16
    float *depth;             // [height][pitch], owned like all: at pixels' middles, 1: nothing
    float *edge[MESH_EDGES];  // depths at the other samples
    // At middles with mesh, all over w: 1; the normal, whose length is the share of the sky; the
    // tint, and after it the share of the sky past the mesh alone.
    float *inverse, *normal[3], *tint[4];
    float *memory; // of all arrays
    size_t room;
} MeshSurface;

// Makes room. RESULT_FAILED if memory is short.
Result mesh_surface_resize(MeshSurface *surface, int width, int height, Error *error);
void mesh_surface_destroy(MeshSurface *surface);

// Fills the surface. `rows`: as above, with u and v in px of the window and depths from the eye as
// OpenGL has them.
Result mesh_raster_surface(MeshRaster *raster, const PlacedMesh *mesh, const float rows[4][4],
                           MeshSurface *surface, int parts, Error *error);
