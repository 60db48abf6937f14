// SPDX-License-Identifier: MIT
// The pose: the strand that is drawn, rebuilt from unit directions, or from the style alone
// (glsl/sim/pose.comp).
#pragma once

#include "sim/step.h"

// What the drawn directions are made of; the values are those of MIX in pose.comp.
typedef enum PoseMix { POSE_STYLE, POSE_PHYSICAL, POSE_NEAR_PHYSICAL, POSE_NEAR_STYLE } PoseMix;

typedef struct Pose {
    StepPass pass;
    float turn_cos[8], turn_sin[8]; // see pose.c
} Pose;

// `style` 0 draws the physical strand, 1 the style, between them every direction is turned by that
// share of the angle between both (slerp, to 3e-7 rad); the shader variant has only what that
// needs. Errors of shader_build_compute.
Result pose_create(Pose *pose, const Gpu *gpu, float style, Error *error);
void pose_destroy(Pose *pose);

// Writes the batch's positions. `segments`: vec4 a particle (unit direction in the world, rest
// length) in the batch's order; NULL where `style` is 1. Queues GPU work, its result is visible to
// texture fetches and storage reads that follow.
void pose_write(Pose *pose, const HairBatch *batch, const GpuBuffer *segments,
                const HeadPose *head);
