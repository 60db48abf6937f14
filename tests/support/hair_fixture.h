// SPDX-License-Identifier: MIT
// Strands on the GPU with a solver, for tests that step hair.
#pragma once

#include "sim/solver.h"

typedef struct HairFixture {
    Hair hair;
    Solver solver;
    SectionParams params;
    GpuTimer timer;
    Colliders colliders;
    const DistanceField *field; // NULL: none; not owned
    bool sheltered;
    SolverStep step; // gravity, dt, head at rest; tests change it between steps
} HairFixture;

// The context of a test program, made at the first call; the test fails if there is none.
const Gpu *fixture_gpu(void);

// What the driver's rounding adds up to, against a CPU driver's. A CPU's operations round to half a
// unit in the last place; GLSL allows 2.5 for divisions and 2 for inverse square roots (GLSL 4.30,
// 4.7.1): 1 for a CPU driver, 5 for a GPU and for maths that is made wrong (gpu/assume.h).
double fixture_rounding(void);

// That the member `name` ("Block.member", arrays with "[0]") of a program's uniform block lies
// where C has it.
void fixture_assert_offset(GLuint program, const char *name, size_t expected);

// `count` strands of n particles each: positions[(s * n + j)]. Gravity (0, -9.81, 0), 1/60 s, no
// wind, head at the origin, first step from rest. `style` as the parameter; drag in 1/s. The
// fixture may be destroyed when zeroed.
void fixture_create(HairFixture *fixture, const double (*positions)[3], int count, int n,
                    const char *algo, const char *variant, float style, float drag);

// The same with parameters that `tune`, which may be NULL, changes before the solver is made.
void fixture_create_tuned(HairFixture *fixture, const double (*positions)[3], int count, int n,
                          const char *algo, const char *variant, float style, float drag,
                          void (*tune)(SectionParams *params));
void fixture_create_strands(HairFixture *fixture, const Strands *strands, const char *algo,
                            const char *variant, float style, float drag);
void fixture_destroy(HairFixture *fixture);

// Makes the solver anew, with the shapes that `text` lists (colliders_parse).
void fixture_collide(HairFixture *fixture, const char *text);

// Makes the solver anew, with the parameters as they are now.
void fixture_solve_anew(HairFixture *fixture);

// The same, with regard to the step's shelter.
void fixture_shelter(HairFixture *fixture);

// One step, then the head of this step becomes the old one.
void fixture_step(HairFixture *fixture);

// Fails unless every drawn position of batch 0 is finite.
void fixture_require_finite(HairFixture *fixture);

// The drawn positions of batch `batch` (after writing the pose), by hair_address; malloc'ed.
float (*fixture_positions(HairFixture *fixture, uint32_t batch))[4];
