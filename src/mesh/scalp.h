// SPDX-License-Identifier: MIT
// Surfaces for hair to grow on: a sphere, or a mannequin's head (head.h). Both are about the
// origin. Metres, y up, face towards +z.
#pragma once

#include "base/double3.h"
#include "mesh/mesh.h"

#include <stdbool.h>
#include <stdint.h>

typedef enum ScalpShape {
    SCALP_SPHERE, // radius 0.1
    SCALP_HEAD,   // 0.23 high, 0.16 wide, 0.2 deep, with neck and shoulders
} ScalpShape;

// Distance of a point from the surface, m, negative inside.
double scalp_distance(ScalpShape shape, const Double3 at);

// Lifts a point to at least `gap` (m) over the surface; the head's hollows may leave it a little
// lower.
void scalp_lift(ScalpShape shape, Double3 point, double gap);

// Where a strand grows.
typedef struct ScalpRoot {
    Double3 direction; // of unit length, seen from the origin
    double radius;     // distance from the origin, m: of the surface's outermost point there
    Double3 normal;    // of the surface, of unit length, outwards
} ScalpRoot;

// A sequence of roots: even over the area, and so is any number of them from the first on.
typedef struct ScalpRoots {
    ScalpShape shape;
    bool everywhere;
    Double3 shift;   // of the sequence, 0 .. 1
    double heaviest; // largest area per solid angle, over the unit sphere's
    uint64_t next;
} ScalpRoots;

// Hair grows on the sphere's upper part (y > 0.2 of the radius) or all of it (`everywhere`), and on
// the head above its hair line. The same seed gives the same roots.
ScalpRoots scalp_roots_begin(ScalpShape shape, bool everywhere, uint32_t seed);

// The next `count` roots, found by several threads; the same in any number of calls.
void scalp_roots_take(ScalpRoots *roots, ScalpRoot *root, uint32_t count);

// A closed mesh whose vertices lie on the surface; 3 <= rings <= 4096. The sphere has `rings` bands
// between the poles and 2 * rings squares around, 4 * rings * (rings - 1) triangles; the head has
// as many, where they suffice. Texture coordinates are longitude (0.5 in front, the seam at the
// back) and latitude (1 on top).
Result scalp_make_mesh(Mesh *mesh, ScalpShape shape, uint32_t rings, Error *error);
