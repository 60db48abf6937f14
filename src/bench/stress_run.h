// SPDX-License-Identifier: MIT
// Steps strands of stress_case.h and checks whether they keep their bounds (stress_bound.h).
#pragma once

#include "bench/stress_case.h"
#include "gpu/gpu.h"

// What may break, in the order of stress_params.h.
typedef enum StressRule { STRESS_FINITE, STRESS_LENGTHS, STRESS_ENERGY, STRESS_REST } StressRule;
enum { STRESS_RULES = 4 };
extern const char *const STRESS_RULE_NAMES[STRESS_RULES];

typedef struct StressVerdict {
    int first[STRESS_RULES];    // the first step that broke it, as far as looked at; 0: none did
    double worst[STRESS_RULES]; // length error, energy and move over what is allowed
    bool flutters;              // it may flutter: energy and rest were not looked at
} StressVerdict;

// Steps `count` strands of one set, `steps` steps. `strands` differ in what is a strand's own, and
// have consecutive numbers. Using more than the share `allowed` (0 to 1] of a bound breaks it.
// Looks at each of the first 64 steps, at eight after each jump of the head, at every sixteenth of
// the others and at the last. RESULT_INTERRUPTED if one was asked for; errors of solver_create.
Result stress_run(StressVerdict *verdicts, const Gpu *gpu, const StressCase *strands, int count,
                  int steps, double allowed, Error *error);
