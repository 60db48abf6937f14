// SPDX-License-Identifier: MIT
// The room mesh: triangle meshes on the CPU. It takes files (mesh_read.h, mesh_sequence.h) or
// shapes of its own (scalp.h), and hands on meshes, and surfaces that say where a point of a mesh
// is, how it lies and how far away it is (surface.h).
//
// This file: a triangle mesh, of a head or a body.
#pragma once

#include "base/error.h"

#include <stdbool.h>
#include <stdint.h>

// Everything is owned by the struct; a zeroed one is a valid empty mesh.
typedef struct Mesh {
    uint32_t vertex_count, triangle_count;
    float (*position)[3];    // [vertex_count], metres, y up
    float (*normal)[3];      // [vertex_count], unit length
    uint32_t (*triangle)[3]; // [triangle_count], below vertex_count, counter-clockwise from outside
    uint32_t uv_count;
    float (*uv)[2];             // [uv_count], texture coordinates; NULL: the mesh has none
    uint32_t (*triangle_uv)[3]; // [triangle_count], of the corners: below uv_count or MESH_NO_UV
} Mesh;

#define MESH_NO_UV UINT32_MAX

// Of files, m: squares of it are finite.
#define MESH_MOST_COORDINATE 1e18f

// Makes room; all arrays are zero. RESULT_FAILED when memory is short.
Result mesh_create(Mesh *mesh, uint32_t vertex_count, uint32_t triangle_count, Error *error);
void mesh_destroy(Mesh *mesh);

// Makes room for texture coordinates, all zero; no corner has one yet. RESULT_FAILED when memory is
// short.
Result mesh_create_uv(Mesh *mesh, uint32_t uv_count, Error *error);

// Smooth normals: the normalised sum of the normals of a vertex's triangles, weighted by area;
// (0, 1, 0) where they cancel out or there are none.
void mesh_compute_normals(Mesh *mesh);

// Axis-aligned box around all vertices; {0,0,0} twice for an empty mesh.
void mesh_bounds(const Mesh *mesh, float low[3], float high[3]);
