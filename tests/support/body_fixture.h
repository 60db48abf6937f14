// SPDX-License-Identifier: MIT
// A mesh that deforms by a formula below the strands of a simulation_fixture: a sheet, unless the
// test has another.
#pragma once

#include "support/simulation_fixture.h"

// The place of the mesh's point `rest` (m) at `time` (s).
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

// The sheet alone, through the roots of a simulation_fixture: x from 0 to 0.2, y 1.6, z about 0.
void body_fixture_make_sheet(Mesh *mesh);

// The second half of body_fixture_create, for tests with a mesh or strands of their own: binds the
// strands of `base` to `mesh`, which moves by `motion` and takes its shape at time 0.
void body_fixture_bind(BodyFixture *fixture, BodyMotion *motion, double rate, double start,
                       uint32_t count);

// All drawn positions of the section's guides or followers: [count], malloc'ed.
float (*body_fixture_positions(BodyFixture *fixture, bool followers, size_t *count))[3];

// Makes a sequence of a mesh that moves by a formula: [count] samples.
void body_fixture_sample(MeshSequence *sequence, const Mesh *rest, BodyMotion *motion, double rate,
                         double start, uint32_t count);
