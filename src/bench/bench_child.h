// SPDX-License-Identifier: MIT
// This program again, in an environment of its own: what depends on how a driver is started can be
// measured in no other way.
#pragma once

#include "bench/bench_options.h"

#include <jansson.h>

// A variable of the environment and its value.
typedef struct ChildVariable {
    const char *name, *value;
} ChildVariable;

// Runs `tractrix-bench speed --part sets` for the method on a set or file (the other is NULL) with
// `steps` after `warm_up`, and the variables set. Gives its first row, which the caller owns, and
// the wall time of the whole process. RESULT_FAILED if it fails.
Result child_measure(const BenchOptions *options, const Method *method, const char *set,
                     const char *file, int steps, int warm_up, const ChildVariable *variables,
                     int variable_count, json_t **row, double *wall_ms, Error *error);
