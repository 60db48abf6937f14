// SPDX-License-Identifier: MIT
// Surfaces on which hair grows: a sphere or a mannequin's head (head.h). Both are centred at the
// origin. Metres, y up, facing +z.
#pragma once

#include "base/double3.h"
#include "mesh/mesh.h"

#include <stdbool.h>
#include <stdint.h>

typedef enum ScalpShape {
    SCALP_SPHERE, // radius 0.1
    SCALP_HEAD,   // 0.23 high, 0.16 wide, 0.2 deep, with neck and shoulders
} ScalpShape;

// Signed distance of a point from the surface, m, negative inside.
double scalp_distance(ScalpShape shape, const Double3 at);

// Moves a point to at least `gap` (m) above the surface; in the hollows of the head it may stay
// slightly lower.
void scalp_lift(ScalpShape shape, Double3 point, double gap);

// The root of a strand.
typedef struct ScalpRoot {
    Double3 direction; // unit vector from the origin
    double radius;     // m from the origin, of the surface's outermost point in that direction
    Double3 normal;    // outward unit normal of the surface
} ScalpRoot;

// A sequence of roots, evenly distributed over the area; so are the first n of them for any n.
typedef struct ScalpRoots {
    ScalpShape shape;
    bool everywhere;
    Double3 shift;   // offset of the sequence, 0 .. 1
    double heaviest; // largest area per solid angle, relative to the unit sphere
    uint64_t next;
} ScalpRoots;

// Hair grows on the sphere's upper part (y > 0.2 of the radius) or on all of it (`everywhere`), and
// on the head above its hair line. The same seed gives the same roots.
ScalpRoots scalp_roots_begin(ScalpShape shape, bool everywhere, uint32_t seed);

// The next `count` roots, computed by several threads. The results do not depend on how calls split
// the sequence.
void scalp_roots_take(ScalpRoots *roots, ScalpRoot *root, uint32_t count);

// A closed mesh with vertices on the surface; 3 <= rings <= 4096. The sphere has `rings` bands
// between the poles and 2 * rings quads around, that is 4 * rings * (rings - 1) triangles; the head
// has at most as many. Texture coordinates are longitude (0.5 in front, the seam at the back) and
// latitude (1 on top).
Result scalp_make_mesh(Mesh *mesh, ScalpShape shape, uint32_t rings, Error *error);
