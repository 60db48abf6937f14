// SPDX-License-Identifier: MIT
// Surfaces for hair to grow on: a sphere, or a plain head with a neck. Both are stars about the
// origin: each direction from there meets the surface once. Metres, y up, face towards +z.
#pragma once

#include "base/double3.h"
#include "mesh/mesh.h"

#include <stdbool.h>
#include <stdint.h>

typedef enum ScalpShape {
    SCALP_SPHERE, // radius 0.1
    SCALP_HEAD,   // 0.3 high, 0.16 wide, 0.2 deep, the neck included
} ScalpShape;

// Distance of the surface from the origin in a direction of unit length.
double scalp_radius(ScalpShape shape, const Double3 direction);

// Normal of unit length, outwards, of the surface in a direction of unit length.
void scalp_normal(ScalpShape shape, const Double3 direction, Double3 normal);

// Directions of roots, one after the other: even over the area, and so is any number of them from
// the first on.
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
// The next root's direction, of unit length.
void scalp_roots_next(ScalpRoots *roots, Double3 direction);

// A closed mesh of `rings` bands between the poles, 2 * rings squares around: 4 * rings *
// (rings - 1) triangles; 3 <= rings <= 4096. Its vertices lie on the surface.
// Texture coordinates are longitude (0.5 in front, the seam at the back) and latitude (1 on top).
Result scalp_make_mesh(Mesh *mesh, ScalpShape shape, uint32_t rings, Error *error);

// Appends neck, shoulders, upper arms and chest under the head, for hair to fall on; they overlap
// each other and the head's neck. RESULT_FAILED when memory is short.
Result scalp_append_shoulders(Mesh *mesh, Error *error);
