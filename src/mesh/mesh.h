// SPDX-License-Identifier: MIT
// The room mesh: triangle meshes on the CPU. Input: meshes of files, which the room formats reads,
// or built-in shapes (scalp.h). Output: meshes, and surfaces, which answer queries about points of
// a mesh, normals and distances (surface.h).
//
// This file: the triangle mesh of a head or a body.
#pragma once

#include "base/error.h"

#include <stdbool.h>
#include <stdint.h>

// The struct owns everything; a zeroed struct is a valid empty mesh.
typedef struct Mesh {
    uint32_t vertex_count, triangle_count;
    float (*position)[3];    // [vertex_count], metres, y up
    float (*normal)[3];      // [vertex_count], unit length
    uint32_t (*triangle)[3]; // [triangle_count], below vertex_count, counter-clockwise from outside
    uint32_t uv_count;
    float (*uv)[2];             // [uv_count], texture coordinates; NULL if there are none
    uint32_t (*triangle_uv)[3]; // [triangle_count], texture coordinates of the corners: below
                                // uv_count or MESH_NO_UV
} Mesh;

#define MESH_NO_UV UINT32_MAX

// Limit for files, m; its square is finite.
#define MESH_MOST_COORDINATE 1e18f

// Allocates the arrays, all zeroed. RESULT_FAILED when memory is short.
Result mesh_create(Mesh *mesh, uint32_t vertex_count, uint32_t triangle_count, Error *error);
void mesh_destroy(Mesh *mesh);

// Allocates texture coordinates, zeroed; no corner refers to them yet. RESULT_FAILED when memory is
// short.
Result mesh_create_uv(Mesh *mesh, uint32_t uv_count, Error *error);

// Computes smooth normals: the normalised sum of the normals of a vertex's triangles, weighted by
// area; (0, 1, 0) if the sum is 0 or there are no triangles.
void mesh_compute_normals(Mesh *mesh);

// Subtracts an origin (m) from all positions.
void mesh_take_away(Mesh *mesh, const double origin[3]);

// The axis-aligned bounding box of all vertices; {0,0,0} twice for an empty mesh.
void mesh_bounds(const Mesh *mesh, float low[3], float high[3]);
// Its diagonal, in the unit of the positions.
double mesh_diagonal(const Mesh *mesh);
