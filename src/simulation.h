// SPDX-License-Identifier: MIT
// A scene in motion: each section's hair with its solver, advanced frame by frame.
#pragma once

#include "follow.h"
#include "scene.h"
#include "solver.h"
#include "strands.h"

typedef struct SimulationSection {
    Hair hair;
    Solver solver;
    Follow follow;
    bool posed; // positions are written ...
    HeadPose
        posed_at; // ... for this head; a static section needs no other pose while the head is there
} SimulationSection;

typedef struct Simulation {
    const Scene *scene;
    GpuTimer *timer;
    SimulationSection *sections; // [scene->section_count]
    HeadPose head;               // now
    int frame;                   // now: time = frame / fps, frame 0 is the start, at rest
    uint64_t steps, poses, poses_skipped;
} Simulation;

// Uploads strands[section] and makes the solvers. `gpu`, `timer`, `scene` outlive the simulation.
// Errors of hair_create and solver_create, prefixed with the section's file.
Result simulation_create(Simulation *simulation, const Gpu *gpu, GpuTimer *timer,
                         const Scene *scene, const Strands *strands, Error *error);
void simulation_destroy(Simulation *simulation);

// To the next frame: `substeps` steps of each section. Only queues GPU work.
void simulation_advance(Simulation *simulation);

// Writes the positions that are drawn. Skips what has not changed.
void simulation_pose(Simulation *simulation);

// True if no frame differs from the first but by the camera: no solver, head at rest.
bool simulation_is_still(const Simulation *simulation);

// Adds up the solvers' reports. Waits for the GPU.
SolverReport simulation_report(const Simulation *simulation);
