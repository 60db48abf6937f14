// SPDX-License-Identifier: MIT
// Meshes in PLY files, text and binary: an element `vertex` with x, y and z, and `face` with a list
// vertex_indices (or vertex_index). Normals are made from the triangles; all else is stepped over.
#pragma once

#include "base/bytes.h"
#include "mesh/mesh.h"

bool ply_mesh_matches(const Bytes *bytes);

// As mesh_read; `path` stands in messages. The mesh is to be destroyed in any case.
Result ply_mesh_read(Mesh *mesh, const char *path, const Bytes *bytes, float unit, bool up_z,
                     Error *error);
