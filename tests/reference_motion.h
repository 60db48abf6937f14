// SPDX-License-Identifier: MIT
// The exact motion of chains of particles (../shared/reference, outside this repository): how far a
// solver is from it.
#pragma once

#include "hair_fixture.h"

// Whether the reference is there; prints a line that says what is skipped if it isn't.
bool motion_available(void);

// RMS of |x - exact| / strand length over particles and 1/60 s frames of 2 s, as far as float32 can
// follow (start rounding moves the exact strand by less than 1e-4), of a scenario such as
// "a_horizontal_n16_c4". `steps_per_frame` steps of a frame; `tune`, which may be NULL, changes
// parameters that are read at each step.
double motion_error(const char *scenario, const char *algo, const char *variant,
                    int steps_per_frame, void (*tune)(SectionParams *params));

// Its geometric mean over the 13 scenarios.
double motion_mean_error(const char *algo, const char *variant, int steps_per_frame,
                         void (*tune)(SectionParams *params));
