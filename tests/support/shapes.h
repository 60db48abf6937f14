// SPDX-License-Identifier: MIT
// Meshes for tests.
#pragma once

#include "mesh/scalp.h"
#include "mesh/surface.h"

// A sphere around the origin, made of rings and sectors, and two poles. Its vertices lie on the
// sphere; triangles face outwards. The test fails if memory is short.
void shapes_make_sphere(Mesh *mesh, int rings, int sectors, float radius);

// The mesh of scalp_make_mesh, and its surface. The test fails if memory is short.
typedef struct Scalp {
    Mesh mesh;
    Surface surface;
} Scalp;

void shapes_make_scalp(Scalp *scalp, ScalpShape shape, uint32_t rings);
void shapes_destroy_scalp(Scalp *scalp);
