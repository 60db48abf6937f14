// SPDX-License-Identifier: MIT
// Frames between two steps of the simulation (glsl/sim/inbetween.comp). Keeps the drawn positions
// after both steps, and restores the later ones before the next step: they are a part of the state
// of solvers that move every particle.
#pragma once

#include "sim/step.h"

// A zeroed struct may be destroyed.
typedef struct Inbetween {
    const Hair *hair;
    const GpuBuffer *frames;
    GpuBuffer *earlier, *later; // [hair->batch_count], vec4 a particle as in HairBatch.position
    StepPass pass;
    bool mixed; // Hair's positions are not `later` now
} Inbetween;

// `hair` and `frames`, of bound strands (bound_set_between; NULL: none), outlive it. RESULT_FAILED
// when memory is short.
Result inbetween_create(Inbetween *inbetween, const Gpu *gpu, const Hair *hair,
                        const GpuBuffer *frames, Error *error);
void inbetween_destroy(Inbetween *inbetween);

// Copies the positions that are drawn now to the earlier or the later ones. All of these only queue
// GPU work.
void inbetween_keep(Inbetween *inbetween, bool later);

// Writes Hair's positions: `share` (0 .. 1) of the way from the earlier to the later ones. Heads
// are those of both steps, and the one to draw.
void inbetween_mix(Inbetween *inbetween, float share, const HeadPose *earlier,
                   const HeadPose *later, const HeadPose *now);

// Restores the later positions if they were mixed. Call before a step.
void inbetween_restore(Inbetween *inbetween);
