// SPDX-License-Identifier: MIT
// A scene of one section in motion, for tests that go from frame to frame.
#pragma once

#include "sim/simulation.h"

typedef struct SimulationFixture {
    Scene scene;
    Strands strands;
    GpuTimer timer;
    Simulation simulation;
} SimulationFixture;

// A scene with 20 curls of 8 and of 12 vertices and the head turning to and fro; `algo` with
// `variant`. Values of the scene's run may be changed before simulation_fixture_start.
void simulation_fixture_create(SimulationFixture *fixture, const char *algo, const char *variant);

// Makes the simulation and lets the hair settle: frame 0. The test fails on any error.
void simulation_fixture_start(SimulationFixture *fixture);
void simulation_fixture_destroy(SimulationFixture *fixture);

// Advances to the frame (not before the present one) and writes its positions.
void simulation_fixture_go(SimulationFixture *fixture, int frame);

// A hash of the drawn positions, bit for bit; and of the drawn head.
uint64_t simulation_fixture_hash(SimulationFixture *fixture);

// Drawn position of vertex `vertex` of the first strand of batch `batch`.
void simulation_fixture_read(SimulationFixture *fixture, uint32_t batch, uint32_t vertex,
                             float position[3]);

// Calls `check` for each solver that steps (TEST_ALGO: only that one) with each of its variants.
void simulation_fixture_each(void (*check)(const char *algo, const char *variant));
