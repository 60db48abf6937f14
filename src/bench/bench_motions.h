// SPDX-License-Identifier: MIT
// Errors against exact motions (motion.h), by the time step.
#pragma once

#include "bench/bench_accuracy.h"
#include "bench/bench_trial.h"

// RMS of |x - exact| over the strand's length, over particles 1 .. n-1 and those frames that
// float32 can follow and that steps of 1/rate s meet. `params` say which solver, and its
// parameters; drag is the motion's, the wind blows evenly. NaN if no frame is met. RESULT_USAGE and
// others as solver_create.
Result accuracy_measure(double *error_over_length, const Gpu *gpu, const Motion *motion,
                        const SectionParams *params, double rate, Error *error);

// A strand of the motion at rest in its start, with its drag and wind.
Result motions_start(Trial *trial, const Gpu *gpu, const Motion *motion,
                     const SectionParams *params, double rate, Error *error);

// A step, at whose end the root is where the motion has it.
void motions_advance(Trial *trial, const Motion *motion);

// Reads accuracy->motions from accuracy->folder.
Result motions_read(Accuracy *accuracy, Error *error);

// Geometric mean of the errors over the motions that are averaged: MOTIONS_MEAN of them, or all
// that a folder has if it lacks one of those.
Result motions_mean(Accuracy *accuracy, const Method *method, double rate, double *mean,
                    Error *error);

// The part: rows for every motion and rate, their orders, and the same for the mean.
Result motions_run(Accuracy *accuracy, Error *error);
