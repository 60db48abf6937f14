// SPDX-License-Identifier: MIT
// How far solvers are from exact motions (motion.h), by the time step.
#pragma once

#include "gpu.h"
#include "motion.h"
#include "params.h"

#include <jansson.h>
#include <stdio.h>

enum { ACCURACY_MOST_RATES = 8 };

typedef struct AccuracyOptions {
    const char *reference;             // folder of exact motions; NULL: those that ship
    const char *algo, *variant;        // NULL: all solvers that step, in their default form
    double rates[ACCURACY_MOST_RATES]; // steps a second
    int rate_count;
} AccuracyOptions;

// All solvers at 60, 120 and 240 Hz.
AccuracyOptions accuracy_options_default(void);

// RMS of |x - exact| over the strand's length, over particles 1 .. n-1 and those frames that
// float32 can follow and that steps of 1/rate s meet. `params` say which solver, and its
// parameters; drag is the motion's, the wind blows evenly. NaN if no frame is met. RESULT_USAGE and
// others as solver_create.
Result accuracy_measure(double *error_over_length, const Gpu *gpu, const Motion *motion,
                        const SectionParams *params, double rate, Error *error);

// The slope of log(error) against log(1/rate), least squares; 0 for less than two of them.
double accuracy_order(const double *rates, const double *errors, int count);

// Writes lines of CSV: algo, variant, scenario, an error for each rate, order; after each solver's
// scenarios one named "mean", their geometric mean. `rows` is an array that the same goes to, or
// NULL. RESULT_FAILED, after all lines, if a stated bound is broken: the message names the first
// and how many. Bounds are those of the default forms; they hold for the 13 motions that ship,
// however many frames of them the folder has.
Result accuracy_run(const Gpu *gpu, const AccuracyOptions *options, FILE *stream, json_t *rows,
                    Error *error);
