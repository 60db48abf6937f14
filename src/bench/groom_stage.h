// SPDX-License-Identifier: MIT
// Simulates a groom with one solver at rest and while the head shakes, like tractrix-render but
// without images.
#pragma once

#include "bench/groom_locks.h"
#include "bench/groom_shape.h"
#include "bench/table.h"
#include "bench/trial.h"
#include "scene/assets.h"
#include "sim/simulation.h"

typedef struct GroomSetup {
    const char *file, *mesh; // hair; OBJ file of the head, NULL: no mesh or the fitted one
                             // (--scalp)
    const char *flags;       // of tractrix-render, "" for none
    Method method;
    double rate;  // steps per second
    int strands;  // maximum, spread evenly over the file; 0: all
    bool shaking; // the head yaws as in groom_stage_shake; otherwise it is still
    bool locks;   // find neighbours, for GroomShake.together
} GroomSetup;

// groom_stage_create fills some members; the others are zeroed.
typedef struct GroomStage {
    char *words; // words of the flags
    Scene scene;
    Assets assets;
    GpuTimer timer;
    Simulation simulation;
    GroomShape shape;
    GroomLocks locks;
    float (*drawn)[3]; // with locks: guides as in `points`, then followers, in world coordinates
    float middle[3];   // of the roots; the head turns about the vertical axis through it
    float (*points)[3], (*before)[3]; // in this frame and the previous one, in the head's frame
    float (*low)[3], (*high)[3];      // box of each tip in the measured period
} GroomStage;

// RESULT_USAGE unless the file is hair; errors of all parts of a run. The stage may be destroyed in
// either case.
Result groom_stage_create(GroomStage *stage, const Gpu *gpu, const GroomSetup *setup, Error *error);
void groom_stage_destroy(GroomStage *stage);

// Depths as groom_shape_depth.
typedef struct GroomRest {
    double mean, tips; // distance from the groom relative to strand length
    double voxels;     // occupied by hair, relative to the groom's
    double jitter;     // largest move of a particle between two frames, relative to strand length
    double deepest, beyond;
} GroomRest;

// Simulates 4 s with the head at rest in frames of 1/60 s; jitter is that of the last half second.
// RESULT_INTERRUPTED after an interrupt.
Result groom_stage_rest(GroomStage *stage, GroomRest *rest, Error *error);

typedef struct GroomShake {
    double swing; // amplitude of the tips in the head's frame relative to strand length: the mean
                  // of half the diagonal of the box of a tip's positions in the last period
    double flare; // largest mean distance of the tips from the axis, relative to the groom's
    double together; // smallest share of neighbours that are still close (groom_locks_kept), guides
                     // and followers, in the last period; 0 without locks
    double deepest, beyond; // in the last period
    Times step;             // ms per step with all its passes, in the two periods before
} GroomShake;

// Simulates 3 s in which the head yaws by +-40 degrees once per second.
Result groom_stage_shake(GroomStage *stage, GroomShake *shake, Error *error);
