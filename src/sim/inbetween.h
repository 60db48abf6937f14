// SPDX-License-Identifier: MIT
// Frames between two steps of the simulation (glsl/sim/inbetween.comp). Keeps the drawn positions
// after both steps, and restores the later positions before the next step, because they are part
// of the state of solvers that move every particle.
#pragma once

#include "sim/step.h"

// A zeroed struct may be destroyed.
typedef struct Inbetween {
    const Hair *hair;
    const GpuBuffer *frames;
    GpuBuffer *earlier, *later; // [hair->batch_count], vec4 a particle as in HairBatch.position
    StepPass pass;
    bool mixed; // Hair's positions are interpolated now; they are not `later`
} Inbetween;

// `frames`: those of bound strands (bound_set_between); NULL if hair is not bound. `hair` and
// `frames` must outlive `inbetween`. RESULT_FAILED when memory is short.
Result inbetween_create(Inbetween *inbetween, const Gpu *gpu, const Hair *hair,
                        const GpuBuffer *frames, Error *error);
void inbetween_destroy(Inbetween *inbetween);

// Copies the positions that are drawn now to `earlier` or `later`. This and the following
// functions only queue GPU work.
void inbetween_keep(Inbetween *inbetween, bool later);

// Writes Hair's positions, interpolated between `earlier` (share = 0) and `later` (1). The poses
// are those of the head after both steps, and the head's pose in the drawn frame.
void inbetween_mix(Inbetween *inbetween, float share, const HeadPose *earlier,
                   const HeadPose *later, const HeadPose *now);

// Restores the later positions if they were mixed. Call before a step.
void inbetween_restore(Inbetween *inbetween);
