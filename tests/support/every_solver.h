// SPDX-License-Identifier: MIT
// Claims about every solver in the table, and the exceptions.
#pragma once

#include "sim/solver.h"
#include "support/twin.h"

// What can be promised ...
enum {
    LENGTHS = 1, // segments as long as in the style
    REST = 2,    // hair that hangs straight down stays so
    ENERGY = 4,  // never more than at the start
    UNIT = 8,    // a scene in centimetres moves like one in metres
    ORDER = 16,  // strands move alike wherever they stand in the file
    TURN = 32,   // a turned scene moves like the scene
    RIGID = 64,  // not only what is drawn has the style's lengths, but what is simulated
};

// What of these a solver's variant promises for strands of `n` particles: all that it is not
// excepted from.
unsigned every_solver_promises(const SolverType *type, const char *variant, int n);

typedef void (*SolverCheck)(const SolverType *type, const char *variant);

// Runs `check` for each solver that steps (TEST_ALGO: only that one) and each of its variants that
// promises `needed` for short strands.
void every_solver_run(SolverCheck check, unsigned needed);

// Fails the test with the solver's name and `format`, which has one double, unless `holds`.
void every_solver_require(bool holds, const SolverType *type, const char *variant,
                          const char *format, double value);

// Greatest error of a link's length, over that length in `style`, less what the rounding of stored
// positions explains.
double every_solver_length_error(const Vec *style, const Vec *q, int n);
