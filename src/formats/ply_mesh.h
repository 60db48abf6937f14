// SPDX-License-Identifier: MIT
// Meshes in PLY files, text and binary: an element `vertex` with x, y and z, and an element `face`
// with a list vertex_indices (or vertex_index). Normals are computed from the triangles; everything
// else is skipped.
#pragma once

#include "base/bytes.h"
#include "mesh/mesh.h"

bool ply_mesh_matches(const Bytes *bytes);

// Like mesh_read; `path` is for messages. The mesh must be destroyed in any case.
Result ply_mesh_read(Mesh *mesh, const char *path, const Bytes *bytes, float unit, bool up_z,
                     Error *error);
