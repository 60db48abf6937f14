// SPDX-License-Identifier: MIT
// Starts this program again with another environment: the only way to measure what depends on a
// driver's start.
#pragma once

#include "base/error.h"
#include "bench/trial.h"
#include "gpu/gpu.h"

#include <jansson.h>

typedef struct ChildRun {
    const Method *method;
    const char *set, *file; // one of the two
    int steps, warm_up;
    const GpuOptions *gpu;
    const char *variable, *value; // of the environment
} ChildRun;

// Runs `tractrix-bench speed --part sets`. Returns its first row, which the caller owns, and the
// wall time of the whole process. RESULT_FAILED if it fails.
Result child_run(const ChildRun *run, json_t **row, double *wall_ms, Error *error);

// A number of the row; NaN: the row lacks it.
double child_number(const json_t *row, const char *name);
