// SPDX-License-Identifier: MIT
// The pose: computes the strand that is drawn, from the root, by unit directions or by the style
// alone (glsl/sim/pose.comp).
#pragma once

#include "sim/step.h"

// How the drawn directions are computed; the values are those of MIX in pose.comp.
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
    bool fades;       // the style changes over time; see Pose.held
    bool bound;       // strands have frames of their own (bound.h): BIND_FRAMES has them
    float hanging[3]; // unit vector in the head's frame, or 0 0 0
} PoseOptions;

typedef struct Pose {
    StepPass pass;
    float turn_cos[8], turn_sin[8]; // see pose.c
    float hanging[3];               // unit vector, or 0 0 0
    bool bound;
    float held; // share of gravity that the style still holds; 1 at first
} Pose;

// With a style between 0 and 1:
// - hanging = 0 0 0: each simulated direction is turned towards the style's direction, by the share
//   `style` of the angle between them (slerp, to 3e-7 rad).
// - hanging = a unit vector h in the head's frame, along which a simulated strand hangs at rest:
//   each segment of the style is turned by the share 1 - style of the smallest rotation from h to
//   the simulated segment. At rest the style is drawn. If a segment points away from h by more than
//   150 degrees, where the rotation's axis becomes undefined, the share fades to 0 or 1.
// The shader is compiled for the chosen case only. Errors of shader_build_compute.
Result pose_create(Pose *pose, const Gpu *gpu, const PoseOptions *options, Error *error);
void pose_destroy(Pose *pose);

// Writes the batch's positions. `segments`: vec4 a particle (unit direction in the world, rest
// length) in the batch's order; NULL if `style` is 1. `lead`: number of segments, from the root,
// that the head carries. With `varies` the caller has bound the table of along.h. Queues GPU work;
// later texture fetches and storage reads see the result.
void pose_write(Pose *pose, const HairBatch *batch, const GpuBuffer *segments, uint32_t lead,
                const HeadPose *head);
