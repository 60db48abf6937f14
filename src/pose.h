// SPDX-License-Identifier: MIT
// The pose: the strand that is drawn, rebuilt from unit directions, or from the style alone
// (glsl/pose.comp).
#pragma once

#include "shader.h"
#include "solver.h"

typedef enum PoseMix { POSE_STYLE, POSE_PHYSICAL, POSE_MIXED } PoseMix;

typedef struct Pose {
    GLuint program;
    GpuBuffer uniforms;
    PoseMix mix;
} Pose;

// `style` 0 draws the physical strand, 1 the style, between them a mix of every direction; the
// shader variant has only what that needs.
Result pose_create(Pose *pose, PoseMix mix, Error *error);
void pose_destroy(Pose *pose);
PoseMix pose_mix_of_style(float style);

// Writes the batch's positions. `segments`: vec4 a particle (unit direction in the world, rest
// length) in the batch's order; NULL for POSE_STYLE. Queues GPU work, its result is visible to
// texture fetches and storage reads that follow.
void pose_write(Pose *pose, const HairBatch *batch, const GpuBuffer *segments, const HeadPose *head,
                float style);
