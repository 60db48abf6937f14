// SPDX-License-Identifier: MIT
// Meshes for tests.
#pragma once

#include "mesh.h"

// A sphere about the origin by rings and sectors, and two poles: its vertices lie on it, triangles
// face outward. The test fails if memory is short.
void shapes_make_sphere(Mesh *mesh, int rings, int sectors, float radius);
