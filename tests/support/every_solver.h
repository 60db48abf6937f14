// SPDX-License-Identifier: MIT
// Promises of all solvers in the table, and the exceptions.
#pragma once

#include "sim/solver.h"
#include "support/twin.h"

// Promises:
enum {
    LENGTHS = 1, // segments have the lengths of the style
    REST = 2,    // hair that hangs straight down stays at rest
    ENERGY = 4,  // the energy never exceeds that of the start
    UNIT = 8,    // a scene in centimetres moves like one in metres
    ORDER = 16,  // the motion of a strand does not depend on its place in the file
    TURN = 32,   // a rotated scene moves like the original
    RIGID = 64,  // LENGTHS holds for simulated positions, not only for drawn ones
};

// The promises of a solver's variant for strands of `n` particles: all without its exceptions.
unsigned every_solver_promises(const SolverType *type, const char *variant, int n);

typedef void (*SolverCheck)(const SolverType *type, const char *variant);

// Runs `check` for each solver that steps (TEST_ALGO: only this solver) and for each of its
// variants that promises `needed` for short strands.
void every_solver_run(SolverCheck check, unsigned needed);

// Unless `holds`, fails the test with the solver's name and `format`, which takes one double.
void every_solver_require(bool holds, const SolverType *type, const char *variant,
                          const char *format, double value);

// The largest error of a link's length over its length in `style`, minus the error that rounding of
// stored positions can cause.
double every_solver_length_error(const Vec *style, const Vec *q, int n);
