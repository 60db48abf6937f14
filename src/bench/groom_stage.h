// SPDX-License-Identifier: MIT
// A groom under one solver: what becomes of it at rest, and while the head shakes. It is simulated
// as tractrix-render does it, without pictures.
#pragma once

#include "bench/groom_locks.h"
#include "bench/groom_shape.h"
#include "bench/table.h"
#include "bench/trial.h"
#include "scene/assets.h"
#include "sim/simulation.h"

typedef struct GroomSetup {
    const char *file, *mesh; // hair; OBJ file of the head, NULL: none or the fitted one (--scalp)
    const char *flags;       // of tractrix-render, "" for none
    Method method;
    double rate;  // steps a second
    int strands;  // at most, spread evenly over the file; 0: all
    bool shaking; // the head yaws as groom_stage_shake says; else it stands
    bool locks;   // find neighbours, for GroomShake.together
} GroomSetup;

// Zeroed but for what groom_stage_create fills.
typedef struct GroomStage {
    char *words; // of the flags
    Scene scene;
    Assets assets;
    GpuTimer timer;
    Simulation simulation;
    GroomShape shape;
    GroomLocks locks;
    float (*drawn)[3]; // with locks: guides as in `points`, then followers, in the world
    float middle[3];   // of the roots: the head turns about the vertical through it
    float (*points)[3], (*before)[3]; // of this frame and the last, the head's frame
    float (*low)[3], (*high)[3];      // of each tip in the period that is measured
} GroomStage;

// RESULT_USAGE unless the file is hair; errors of all that a run consists of. The stage may be
// destroyed in either case.
Result groom_stage_create(GroomStage *stage, const Gpu *gpu, const GroomSetup *setup, Error *error);
void groom_stage_destroy(GroomStage *stage);

// Depths as groom_shape_depth.
typedef struct GroomRest {
    double mean, tips; // distance from the groom over strand length
    double voxels;     // occupied by hair, over those of the groom
    double jitter;     // farthest move of a particle between two frames, over strand length
    double deepest, beyond;
} GroomRest;

// 4 s with the head at rest; frames are 1/60 s, jitter is that of the last half second.
// RESULT_INTERRUPTED if that was asked for.
Result groom_stage_rest(GroomStage *stage, GroomRest *rest, Error *error);

typedef struct GroomShake {
    double swing; // amplitude of the tips in the head's frame over strand length: the mean of half
                  // the diagonal of the box that a tip goes through in the last period
    double flare; // largest mean distance of the tips from the axis, over that in the groom
    double together; // least share of neighbours that still are (groom_locks_kept), guides and
                     // followers, in the last period; 0 without locks
    double deepest, beyond; // in the last period
    Times step;             // ms a step with all its passes, in the two periods before
} GroomShake;

// 3 s in which the head yaws by +-40 degrees once a second.
Result groom_stage_shake(GroomStage *stage, GroomShake *shake, Error *error);
