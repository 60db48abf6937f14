// SPDX-License-Identifier: MIT
// A scene with one moving section, for tests that go from frame to frame.
#pragma once

#include "sim/simulation.h"

typedef struct SimulationFixture {
    Scene scene;
    Strands strands;
    GpuTimer timer;
    Simulation simulation;
} SimulationFixture;

// A scene with 20 curls of 8 and of 12 vertices and a head that turns to and fro; solver `algo`
// with `variant`. The scene's run parameters may be changed before simulation_fixture_start.
void simulation_fixture_create(SimulationFixture *fixture, const char *algo, const char *variant);

// Replaces the strands by 18 of 8, 10 and 12 vertices, before the simulation is made. With as many
// different counts, solvers keep strands in memory and not in registers (sim/step.c).
void simulation_fixture_mix(SimulationFixture *fixture);

// Makes the simulation and lets the hair settle: frame 0. The test fails on any error.
void simulation_fixture_start(SimulationFixture *fixture);
void simulation_fixture_destroy(SimulationFixture *fixture);

// Advances to the frame (not before the current one) and writes its positions.
void simulation_fixture_go(SimulationFixture *fixture, int frame);

// A bitwise hash of the drawn positions and of the drawn head.
uint64_t simulation_fixture_hash(SimulationFixture *fixture);

// The drawn position of vertex `vertex` of the first strand of batch `batch`.
void simulation_fixture_read(SimulationFixture *fixture, uint32_t batch, uint32_t vertex,
                             float position[3]);

// Calls `check` for each solver that steps (TEST_ALGO: only this solver) with each of its variants.
void simulation_fixture_each(void (*check)(const char *algo, const char *variant));
