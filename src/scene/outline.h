// SPDX-License-Identifier: MIT
// What the camera is to keep in sight: the hair over the whole sequence, so that the camera does
// not move with it.
#pragma once

#include "mesh/mesh.h"
#include "scene/scene.h"
#include "strands/strands.h"

// Directions in which a set of points is bounded, spread evenly: any direction is within 13 degrees
// of one, so that the set reaches at most 3 % of its size beyond the points that are kept.
enum { OUTLINE_DIRECTIONS = 96 };

// The points of a set that lie farthest in each direction (the support of a k-DOP), and its box:
// they fill the frame more tightly than the corners of the box alone would. A zeroed struct is an
// empty set.
typedef struct Outline {
    bool any;
    float low[3], high[3];                  // m
    float point[OUTLINE_DIRECTIONS][3];     // m
    float reach[OUTLINE_DIRECTIONS];        // m: of the point along its direction
    float direction[3][OUTLINE_DIRECTIONS]; // unit; x of all, y of all, z of all
} Outline;

typedef struct Framing {
    Outline hair;    // where the hair is expected, in the world
    Outline all;     // with the mesh, for the depth range
    float target[3]; // m, middle of the hair
    float eye[3];    // m, automatic place for a camera that turns by 0
} Framing;

// Takes in `count` points, m.
void outline_add(Outline *outline, const float (*points)[3], size_t count);

// Corner 0..7 of the box.
void outline_corner(const Outline *outline, int which, float corner[3]);

// Finds what the sequence will show without simulating it: the style carried by the head, and the
// shape in which the hair comes to rest: each strand rebuilt from its root with directions between
// that of gravity + drag * wind and the style's, by the section's share of style, and around all of
// it as much room as followers need. Motions are sampled at 16 times. `strands`: one for each of
// the scene's sections, metres. `mesh`: NULL for none. The eye stands in front (+z), 25 degrees to
// the side and 10 degrees above, just so far away that everything stays in the frame with a
// margin (run.margin), at all angles of the turntable. With a floor "everything" is the mesh, too,
// which stands on it.
void outline_frame(Framing *framing, const Scene *scene, const Strands *strands, const Mesh *mesh);
