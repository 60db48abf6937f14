// SPDX-License-Identifier: MIT
// Sleep: hair at rest under constant forces is not stepped until something changes.
//
// While the head stands still and gravity and wind are the same in every step, four times a second
// each drawn particle is compared with its anchor, an earlier position. With the tolerance t in
// lengths of the strand: a strand is calm while all its particles stay within t/4 of their anchors
// and move away from them by no more than t/60 beyond the farthest so far. It is ready after being
// calm for 2 s + 120 s r/t, where r is its tremor about the anchors (float32 and some solvers
// tremble for ever), until it leaves its anchors. Hair is asleep when all its strands are ready.
//
// Largest error: a strand stops up to t/4 off, as far as it trembles. It may also creep, by
// r + t/60 while it was calm; at that speed a minute more would be t/2. Creeping hair gets slower
// and trembling does not move on, so the test is a distance and not a speed. Checks are unevenly
// spaced, so that no swing has their period. Strands that are not ready get new anchors at checks
// 1, 2, 4 .. 64, so that r does not measure what was left of a swing.
//
// The result of a check is read when the next one is due, always in the same step: runs are
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
    SolverStep last;     // the last step, asleep or not
    int steps, due;      // under unchanging forces; number at which the next check is due
    int checks;          // checks so far
    bool asleep;
} Sleep;

// With params->sleep 0 or a solver that steps nothing, the hair never sleeps.
// RESULT_FAILED when memory is short; errors of shader_build_compute.
Result sleep_create(Sleep *sleep, const Gpu *gpu, GpuTimer *timer, const Hair *hair,
                    const Solver *solver, const SectionParams *params, Error *error);
void sleep_destroy(Sleep *sleep);

// Call before each step: true if it may be skipped. A change of gravity, wind, head or step length
// since the last step wakes the hair.
bool sleep_skips(Sleep *sleep, const SolverStep *step);

// Call after each step that was made: checks the hair if that is due, after the solver's pose.
void sleep_check(Sleep *sleep, const Solver *solver);
