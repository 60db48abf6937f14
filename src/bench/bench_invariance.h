// SPDX-License-Identifier: MIT
// What should change nothing: the frame rate, and the unit of length.
#pragma once

#include "bench/bench_accuracy.h"

// The part "rate": two exact motions' starts and heads, hair with the solver's default style; RMS
// distance over the length, over 2 s, between steps of 1/30, 1/60, 1/120 s and those of 1/240 s (or
// between the rates that are asked for and the greatest of them).
Result invariance_run_rate(Accuracy *accuracy, Error *error);

// The part "scale": the same hair in a world of centimetres, all lengths, gravity and parameters
// that are lengths times 100: RMS distance over the length after half a second (stated: 1e-4).
Result invariance_run_scale(Accuracy *accuracy, Error *error);
