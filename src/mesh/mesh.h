// SPDX-License-Identifier: MIT
// A triangle mesh on the CPU: a head or a body, from Wavefront OBJ.
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

// Makes room; all arrays are zero. RESULT_FAILED when memory is short.
Result mesh_create(Mesh *mesh, uint32_t vertex_count, uint32_t triangle_count, Error *error);
void mesh_destroy(Mesh *mesh);

// Makes room for texture coordinates, all zero; no corner has one yet. RESULT_FAILED when memory is
// short.
Result mesh_create_uv(Mesh *mesh, uint32_t uv_count, Error *error);

// Reads `v`, `vt`, `vn` and `f` statements of Wavefront OBJ and passes over all others: corners v,
// v/t, v//n or v/t/n, indices from 1 or negative from the last; polygons become fans around their
// first corner. Texture coordinates that no corner names are left out. A vertex has one normal: the
// sum of all normals that its corners name, or, where they name none, of the normals of its
// triangles by area. `unit` is metres per unit of the file, > 0; `up_z`: (x, y, z) -> (x, z, -y).
// RESULT_BAD_INPUT with "FILE:LINE: ..." for anything malformed, a number that is not finite, an
// index out of range, or a file without faces.
Result mesh_read_obj(Mesh *mesh, const char *path, float unit, bool up_z, Error *error);

// Writes positions, texture coordinates and faces (no normals: reading computes them), numbers as
// the shortest of %.6g .. %.9g that reads back. RESULT_FAILED with the reason.
Result mesh_write_obj(const char *path, const Mesh *mesh, Error *error);

// Smooth normals: the normalised sum of the normals of a vertex's triangles, weighted by area;
// (0, 1, 0) where they cancel out or there are none.
void mesh_compute_normals(Mesh *mesh);

// Axis-aligned box around all vertices; {0,0,0} twice for an empty mesh.
void mesh_bounds(const Mesh *mesh, float low[3], float high[3]);
