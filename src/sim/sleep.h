// SPDX-License-Identifier: MIT
// Sleep: hair at rest under constant forces is not simulated until something changes.
//
// The check runs four times a second while the head stands still and gravity and wind are the same
// in every step. It compares each drawn particle with its anchor, an earlier position of the
// particle. Let t be the tolerance, in lengths of the strand.
// - A strand is calm while all its particles stay within t/4 of their anchors, and none moves away
//   from its anchor by more than t/60 beyond its largest distance so far.
// - A strand is ready after it has been calm for 2 s + 120 s r/t, where r is its tremor about the
//   anchors (with float32 and some solvers a strand trembles for ever). It stays ready until it
//   leaves its anchors.
// - The hair is asleep when all its strands are ready.
//
// Largest error. A strand stops up to t/4 away from its mean position, because it trembles. It may
// also have crept by r + t/60 while it was calm; at that speed it would creep by t/2 in another
// minute. The test uses distances and not speeds, because creeping hair gets slower and slower,
// and trembling hair moves without getting anywhere.
//
// The checks are unevenly spaced, so that no swing has their period. Strands that are not ready
// get new anchors at checks 1, 2, 4 .. 64, so that r does not include the last of a swing.
//
// The result of a check is read when the next check is due, always in the same step. So runs are
// repeatable, and nothing waits for the GPU.
#pragma once

#include "gpu/shader.h"
#include "sim/solver.h"

typedef struct SleepBatch {
    GpuBuffer anchors, calm;
} SleepBatch;

typedef struct Sleep {
    const Hair *hair; // NULL: never sleeps
    GpuTimer *timer;
    float tolerance;
    StepPass pass;
    SleepBatch *batches; // [hair->batch_count]
    SolverStep last;     // the last step, made or skipped
    int steps, due;      // steps under constant forces; the number at which the next check is due
    int checks;          // checks so far
    bool asleep;
} Sleep;

// The hair never sleeps if params->sleep is 0 or the solver is static.
// RESULT_FAILED when memory is short; errors of shader_build_compute.
Result sleep_create(Sleep *sleep, const Gpu *gpu, GpuTimer *timer, const Hair *hair,
                    const Solver *solver, const SectionParams *params, Error *error);
void sleep_destroy(Sleep *sleep);

// Call before each step. True if the step may be skipped. A change of gravity, wind, head or step
// length since the last step wakes the hair.
bool sleep_skips(Sleep *sleep, const SolverStep *step);

// Call after each step that was made. If a check is due, poses the hair and checks it.
void sleep_check(Sleep *sleep, const Solver *solver);
