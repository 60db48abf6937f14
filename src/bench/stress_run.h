// SPDX-License-Identifier: MIT
// Simulates strands of stress_case.h and checks their bounds (stress_bound.h).
#pragma once

#include "bench/stress_case.h"
#include "gpu/gpu.h"

// The bounds, in the order of stress_params.h.
typedef enum StressRule { STRESS_FINITE, STRESS_LENGTHS, STRESS_ENERGY, STRESS_REST } StressRule;
enum { STRESS_RULES = 4 };
extern const char *const STRESS_RULE_NAMES[STRESS_RULES];

typedef struct StressVerdict {
    int first[STRESS_RULES];    // first checked step that broke the bound; 0: none
    double worst[STRESS_RULES]; // length error, energy and motion, relative to their bounds
    bool flutters;              // it may flutter: energy and rest were not checked
} StressVerdict;

// Simulates `count` strands of one set for `steps` steps. The `strands` differ in individual fields
// only and have consecutive numbers. A strand fails if it uses more than the share `allowed` (> 0,
// at most 1) of a bound. Checks each of the first 64 steps, eight after each jump of the head,
// every sixteenth of the others, and the last. RESULT_INTERRUPTED after an interrupt; errors of
// solver_create.
Result stress_run(StressVerdict *verdicts, const Gpu *gpu, const StressCase *strands, int count,
                  int steps, double allowed, Error *error);
