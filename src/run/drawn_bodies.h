// SPDX-License-Identifier: MIT
// Joins the meshes of all bodies into the one mesh that is drawn, in the frame of the first body's
// head. If there is a single body, its vertices are unchanged and move only if its mesh deforms.
#pragma once

#include "scene/assets.h"
#include "sim/simulation.h"

// The part of one body. A zeroed part may be destroyed.
typedef struct DrawnBody {
    uint32_t first; // number of its first vertex in the joined mesh
    bool placed;
    double shape;  // bound_body_shape of the body
    HeadPose way;  // from the frame of its own head to that of the first body's
    Mesh deformed; // a deforming mesh in its current shape; owned
} DrawnBody;

// A zeroed struct is empty and may be destroyed.
typedef struct DrawnBodies {
    const Assets *assets;
    Simulation *simulation;
    Mesh mesh;         // of all bodies, owned; empty: no body has a mesh
    DrawnBody *bodies; // [assets->body_count], owned
} DrawnBodies;

// Joins the meshes in their current shape. `assets` and `simulation` must outlive the result.
// RESULT_FAILED when memory is short; it may be destroyed in either case.
Result drawn_bodies_create(DrawnBodies *drawn, const Assets *assets, Simulation *simulation,
                           Error *error);
void drawn_bodies_destroy(DrawnBodies *drawn);

// Moves the vertices to their positions at the simulation's time. False: none has moved.
bool drawn_bodies_move(DrawnBodies *drawn);
