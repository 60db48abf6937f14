// SPDX-License-Identifier: MIT
// This program again, in an environment of its own: what depends on how a driver is started can be
// measured in no other way.
#pragma once

#include "base/error.h"
#include "bench/trial.h"
#include "gpu/gpu.h"

#include <jansson.h>

typedef struct ChildRun {
    const Method *method;
    const char *set, *file; // one of both
    int steps, warm_up;
    const GpuOptions *gpu;
    const char *variable, *value; // of the environment
} ChildRun;

// Runs `tractrix-bench speed --part sets`. Gives its first row, which the caller owns, and the wall
// time of the whole process. RESULT_FAILED if it fails.
Result child_run(const ChildRun *run, json_t **row, double *wall_ms, Error *error);

// A number of the row; NaN: it has none.
double child_number(const json_t *row, const char *name);
