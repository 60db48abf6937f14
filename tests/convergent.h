// SPDX-License-Identifier: MIT
// What the tests of solvers that converge to the motion of rigid chains share (chain, hybrid,
// emulation).
#pragma once

#include "twin.h"

// A strand that is stepped by a solver and by its twin.
typedef struct ConvergentCase {
    int n; // particles
    double per_second, drag, style;
    int steps;
    double tolerance; // of their distance: RMS over the strand's length
} ConvergentCase;

// Fails unless `algo` stays as close to its twin as each of `count` cases asks.
void convergent_equals_twin(const char *algo, TwinFunction twin, const ConvergentCase *cases,
                            int count);

// Fails unless a strand that hangs straight down without drag stays there for 10 s, by 1e-5 of its
// length.
void convergent_stays_at_rest(const char *algo);

// Fails unless lengths hold to 1e-5 when the head jumps by 1000 lengths and back, for 8 and 64
// particles.
void convergent_survives_violence(const char *algo);

// Fails unless the error of `algo` on a released strand is at most `most` of its length at 120 Hz,
// and falls by `ratio` to 480 Hz. Prints it, and that at 60 Hz.
void convergent_falls_with_the_step(const char *algo, double most, double ratio);
