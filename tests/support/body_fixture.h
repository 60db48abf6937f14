// SPDX-License-Identifier: MIT
// A sheet below the strands of a simulation_fixture that deforms by a formula.
#pragma once

#include "support/simulation_fixture.h"

// The place of the sheet's point `rest` (m) at `time` (s).
typedef void BodyMotion(double time, const double rest[3], double place[3]);

typedef struct BodyFixture {
    SimulationFixture base;
    Mesh mesh;
    Body body;
} BodyFixture;

// Makes a flat sheet through all roots, with `columns` cells along x. It has `count` samples,
// `rate` per second, beginning at `start` (s).
void body_fixture_create(BodyFixture *fixture, const char *algo, const char *variant,
                         BodyMotion *motion, double rate, double start, uint32_t count);
void body_fixture_destroy(BodyFixture *fixture);

// All drawn positions of the section's guides or followers: [count], malloc'ed.
float (*body_fixture_positions(BodyFixture *fixture, bool followers, size_t *count))[3];

// Makes a sequence of a mesh that moves by a formula: [count] samples.
void body_fixture_sample(MeshSequence *sequence, const Mesh *rest, BodyMotion *motion, double rate,
                         double start, uint32_t count);
