// SPDX-License-Identifier: MIT
// What the camera must keep in view: the hair over the whole sequence, so that the camera itself
// need not move with it.
#pragma once

#include "mesh/mesh.h"
#include "scene/scene.h"
#include "strands/strands.h"

// Evenly spread directions in which a set of points is bounded. Any direction is within 13 degrees
// of one of them, so the set extends at most 3 % of its size beyond the stored points.
enum { OUTLINE_DIRECTIONS = 96 };

// The farthest points of a set in each direction (the support of a k-DOP), and its box. They fill
// the frame more tightly than the corners of the box. A zeroed struct is an empty set.
typedef struct Outline {
    bool any;
    float low[3], high[3];                  // m
    float point[OUTLINE_DIRECTIONS][3];     // m
    float reach[OUTLINE_DIRECTIONS];        // m, of the point along its direction
    float direction[3][OUTLINE_DIRECTIONS]; // unit vectors; all x, then all y, then all z
} Outline;

typedef struct Framing {
    Outline hair;    // the expected hair, in the world
    Outline all;     // with the mesh, for the depth range
    float target[3]; // m, centre of the hair
    float eye[3];    // m, position of an automatic camera that is not turned
} Framing;

// Adds `count` points (m).
void outline_add(Outline *outline, const float (*points)[3], size_t count);

// Corner 0..7 of the box.
void outline_corner(const Outline *outline, int which, float corner[3]);

// Estimates what the sequence will show without simulating it: the style as moved by the head, and
// the shape in which hair comes to rest. For the latter, each strand is rebuilt from its root with
// directions between gravity + drag * wind and the style, according to the section's style. Space
// for followers is added. Motions are sampled at 16 times. `strands`: metres, one set per section.
// `meshes`: one per body; NULL if there is none. The eye is in front (+z), 25 degrees to the side
// and 10 degrees above, at the distance at which everything stays in the frame with a margin
// (run.margin) at all angles of the turntable. With a floor, "everything" includes the mesh, which
// stands on it.
void outline_frame(Framing *framing, const Scene *scene, const Strands *strands,
                   const Mesh *meshes);
