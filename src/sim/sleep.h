// SPDX-License-Identifier: MIT
// Sleep: hair that has come to rest under forces that do not change is not stepped until something
// changes.
//
// While the head stands still and gravity and wind are the same in every step, four times a second
// each drawn particle is compared with its anchor, a place where it was. With the tolerance t in
// lengths of the strand: a strand is calm while all its particles stay within t/4 of their anchors
// and come no farther from them than they have been, but for t/60. Once a strand has been calm for
// 2 s + 120 s r/t, where r is how far it trembles about its anchors (float32 and some solvers do
// for ever), it is ready, and stays so until it leaves its anchors. Hair is asleep when all its
// strands are ready.
//
// What that can cost: where a strand is stopped it may be off by as far as it trembles, t/4 to
// either side. It may also have been on its way, by r + t/60 in the time that it was calm; if it
// went on as fast for a minute, that would be another t/2. What creeps to rest becomes slower, and
// trembling does not get farther, creeping does, which is why the distance is looked at and not the
// speed. The looks are unevenly spaced, lest a swing has just that period. Anchors are set anew at
// looks 1, 2, 4 .. 64 for strands that are not ready, so that r is not what was left of a swing.
//
// The result of a look is read when the next one is due, always in the same step, so that runs are
// repeatable and a GPU need not be waited for.
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
    int steps, due;      // under unchanging forces; number at which the next look is due
    int looks;           // of these
    bool asleep;
} Sleep;

// With params->sleep 0 or a solver that steps nothing, the hair never sleeps.
// RESULT_FAILED when memory is short; errors of shader_build_compute.
Result sleep_create(Sleep *sleep, const Gpu *gpu, GpuTimer *timer, const Hair *hair,
                    const Solver *solver, const SectionParams *params, Error *error);
void sleep_destroy(Sleep *sleep);

// To be called before each step: true if it may be left out. What wakes: a gravity, wind, head or
// step length that is not the last step's.
bool sleep_skips(Sleep *sleep, const SolverStep *step);

// To be called after each step that was made: looks, if that is due. Has the solver write its pose
// then.
void sleep_look(Sleep *sleep, const Solver *solver);
