// SPDX-License-Identifier: MIT
// The meshes of all bodies as the one mesh that is drawn, in the frame of the first body's head. Of
// one body these are its own vertices, which move only where the mesh deforms.
#pragma once

#include "scene/assets.h"
#include "sim/simulation.h"

// One body's part. A zeroed one may be destroyed.
typedef struct DrawnBody {
    uint32_t first; // of its vertices in the whole
    bool placed;
    double shape;  // bound_body_shape
    HeadPose way;  // from the frame of its own head to that of the first body's
    Mesh deformed; // of a mesh that deforms, as it is now; owned
} DrawnBody;

// A zeroed struct is empty and may be destroyed.
typedef struct DrawnBodies {
    const Assets *assets;
    Simulation *simulation;
    Mesh mesh;         // of all; empty: no body has one; owned
    DrawnBody *bodies; // [assets->body_count], owned
} DrawnBodies;

// Joins the meshes as they are now. `assets` and `simulation` must outlive the result.
// RESULT_FAILED when memory is short; it may be destroyed in either case.
Result drawn_bodies_create(DrawnBodies *drawn, const Assets *assets, Simulation *simulation,
                           Error *error);
void drawn_bodies_destroy(DrawnBodies *drawn);

// Brings the vertices to where they are at the simulation's time. False: none has moved.
bool drawn_bodies_move(DrawnBodies *drawn);
