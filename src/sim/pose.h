// SPDX-License-Identifier: MIT
// The pose: the strand that is drawn, rebuilt from unit directions, or from the style alone
// (glsl/sim/pose.comp).
#pragma once

#include "sim/step.h"

// What the drawn directions are made of; the values are those of MIX in pose.comp.
typedef enum PoseMix {
    POSE_STYLE,
    POSE_PHYSICAL,
    POSE_NEAR_PHYSICAL,
    POSE_NEAR_STYLE,
    POSE_VARIES
} PoseMix;

typedef struct PoseOptions {
    float style;      // 0 draws the physical strand, 1 the style
    bool varies;      // the style's share differs along the strand: BIND_ALONG has it
    bool fades;       // the style changes over time: Pose.held
    bool bound;       // strands have frames of their own (bound.h): BIND_FRAMES has them
    float hanging[3]; // unit vector in the head's frame, or 0 0 0
} PoseOptions;

typedef struct Pose {
    StepPass pass;
    float turn_cos[8], turn_sin[8]; // see pose.c
    float hanging[3];               // unit vector, or 0 0 0
    bool bound;
    float held; // what is left of the style's hold on gravity; 1 at first
} Pose;

// With a style between 0 and 1,
// - hanging 0 0 0: every direction is turned by that share of the angle between both (slerp, to
//   3e-7 rad);
// - hanging a unit vector h in the head's frame, where a strand at rest hangs along h: each segment
//   of the style is turned by 1 - style of the smallest rotation from h to the physical segment, so
//   that the style is what is drawn at rest. Where a segment points nearly the other way (beyond
//   150 degrees) the share fades to none or all of it, as it has no axis there.
// The shader variant has only what that needs. Errors of shader_build_compute.
Result pose_create(Pose *pose, const Gpu *gpu, const PoseOptions *options, Error *error);
void pose_destroy(Pose *pose);

// Writes the batch's positions. `segments`: vec4 a particle (unit direction in the world, rest
// length) in the batch's order; NULL where `style` is 1. `lead`: segments, from the root, that the
// head carries. With `varies` the table (along.h) is bound. Queues GPU work, its result is visible
// to texture fetches and storage reads that follow.
void pose_write(Pose *pose, const HairBatch *batch, const GpuBuffer *segments, uint32_t lead,
                const HeadPose *head);
