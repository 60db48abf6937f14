// SPDX-License-Identifier: MIT
// Reads a static mesh, Wavefront OBJ or PLY depending on its content. Polygons become triangle
// fans.
#pragma once

#include "mesh/mesh.h"

// `unit` is metres per unit of the file, > 0; `up_z`: (x, y, z) -> (x, z, -y). RESULT_BAD_INPUT
// with path and place for malformed content, a number that is not finite, a file without faces, and
// for hair (with a hint); RESULT_FAILED when memory is short.
Result mesh_read(Mesh *mesh, const char *path, float unit, bool up_z, Error *error);
