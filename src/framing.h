// SPDX-License-Identifier: MIT
// What the camera is to keep in sight: the hair over the whole sequence, so that the picture does
// not move with it.
#pragma once

#include "mesh.h"
#include "scene.h"
#include "strands.h"

// Directions in which a set of points is bounded: the 26 to a cube's faces, edges and corners.
enum { FRAMING_DIRECTIONS = 26 };

// The points of a set that lie farthest in each direction: they fill the picture more tightly than
// the corners of a box would. A zeroed struct is an empty set.
typedef struct Outline {
    float point[FRAMING_DIRECTIONS][3]; // m
    bool any;
} Outline;

typedef struct Framing {
    Outline hair;    // where the hair is expected, in the world
    Outline all;     // with the mesh, for the depth range
    float target[3]; // m, middle of the hair
    float eye[3];    // m, automatic place for a camera that turns by 0
} Framing;

void outline_add(Outline *outline, const float point[3]);

// Finds what the sequence will show without simulating it: the style carried by the head, and the
// shape in which the hair comes to rest: each strand rebuilt from its root with directions between
// that of gravity + drag * wind and the style's, by the section's share of style. Motions are
// sampled at 16 times. `strands`: one for each of the scene's sections, metres. `mesh`: NULL for
// none. The eye stands in front (+z), 25 degrees to the side and 10 degrees above, just so far away
// that everything stays in the picture with a margin of 6 %, at all angles of the turntable.
void framing_compute(Framing *framing, const Scene *scene, const Strands *strands,
                     const Mesh *mesh);
