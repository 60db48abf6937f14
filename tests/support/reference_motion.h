// SPDX-License-Identifier: MIT
// The error of a solver against the exact motions in tests/data/motion (every fourth frame of 1/60
// s of 13 scenarios, computed for this project to 4e-10 m).
#pragma once

#include "bench/trial.h"

// trial_error for a scenario such as "a_horizontal_n16_c4" without style, in steps of 1/(60
// steps_per_frame) s. `tune`, which may be NULL, changes parameters.
double reference_error(const char *scenario, const char *algo, const char *variant,
                       int steps_per_frame, void (*tune)(SectionParams *params));

// The geometric mean of reference_error over the 13 scenarios.
double reference_mean_error(const char *algo, const char *variant, int steps_per_frame,
                            void (*tune)(SectionParams *params));
