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
    const DistanceField *field; // NULL if there is none; not owned
    bool sheltered;
    SolverStep step; // gravity, dt, head at rest; tests change it between steps
} HairFixture;

// The OpenGL context of a test program, made at the first call. The test fails if there is none.
const Gpu *fixture_gpu(void);

// The rounding errors of the driver, in units of a CPU driver's. A CPU's operations round to half a
// unit in the last place; GLSL allows 2.5 for divisions and 2 for inverse square roots (GLSL 4.30,
// 4.7.1). So it is 1 for a CPU driver, and 5 for a GPU and for maths that is made inexact
// (gpu/assume.h).
double fixture_rounding(void);

// Checks that the member `name` ("Block.member", arrays with "[0]") of a program's uniform block
// has the offset of the C struct.
void fixture_assert_offset(GLuint program, const char *name, size_t expected);

// Makes `count` strands with n particles each: positions[(s * n + j)]. Gravity (0, -9.81, 0), steps
// of 1/60 s, no wind, head at the origin, starting at rest. `style` as the parameter; drag in 1/s.
// A zeroed fixture may be destroyed.
void fixture_create(HairFixture *fixture, const double (*positions)[3], int count, int n,
                    const char *algo, const char *variant, float style, float drag);

// Like fixture_create. `tune`, which may be NULL, changes parameters before the solver is made.
void fixture_create_tuned(HairFixture *fixture, const double (*positions)[3], int count, int n,
                          const char *algo, const char *variant, float style, float drag,
                          void (*tune)(SectionParams *params));
void fixture_create_strands(HairFixture *fixture, const Strands *strands, const char *algo,
                            const char *variant, float style, float drag);
void fixture_destroy(HairFixture *fixture);

// Makes the solver again, with the shapes that `text` lists (colliders_parse).
void fixture_collide(HairFixture *fixture, const char *text);

// Makes the solver again, with the current parameters.
void fixture_solve_anew(HairFixture *fixture);

// Makes the solver again, with the step's shelter.
void fixture_shelter(HairFixture *fixture);

// Makes one step. Then the head of this step becomes the old head.
void fixture_step(HairFixture *fixture);

// Fails unless every drawn position of batch 0 is finite.
void fixture_require_finite(HairFixture *fixture);

// The drawn positions of batch `batch` (after writing the pose), addressed by hair_address;
// malloc'ed. Fails unless each has w = 1.
float (*fixture_positions(HairFixture *fixture, uint32_t batch))[4];
