// SPDX-License-Identifier: MIT
// A sheet that deforms under the strands of a simulation_fixture, by a formula.
#pragma once

#include "support/simulation_fixture.h"

// Where the sheet's point `rest` (m) is at `time` (s).
typedef void BodyMotion(double time, const double rest[3], double place[3]);

typedef struct BodyFixture {
    SimulationFixture base;
    Mesh mesh;
    Body body;
} BodyFixture;

// A flat sheet through all roots, of `columns` cells along x, sampled `rate` times a second from
// `start` (s) on, `count` times.
void body_fixture_create(BodyFixture *fixture, const char *algo, const char *variant,
                         BodyMotion *motion, double rate, double start, uint32_t count);
void body_fixture_destroy(BodyFixture *fixture);

// All drawn positions of the section's guides, or followers: [count], malloc'ed.
float (*body_fixture_positions(BodyFixture *fixture, bool followers, size_t *count))[3];

// A sequence of a mesh by a formula: [count] samples.
void body_fixture_sample(MeshSequence *sequence, const Mesh *rest, BodyMotion *motion, double rate,
                         double start, uint32_t count);
