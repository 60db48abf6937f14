// SPDX-License-Identifier: MIT
// The head's motion, and its effects on all hair beyond pulling at the roots: the head may already
// move at time 0, and it may jump.
#pragma once

#include "scene/scene.h"
#include "strands/strands.h"

#include <cglm/types.h>

// The head's rigid frame: x_world = rotation x_head + translation.
typedef struct HeadPose {
    versor rotation;  // unit quaternion x y z w
    vec3 translation; // metres
} HeadPose;

// A motion of hair as one rigid body: x' = R x + translation, v' = R v + velocity + spin x x'.
typedef struct HeadMotion {
    versor rotation;  // unit quaternion x y z w of R
    vec3 translation; // m
    vec3 velocity;    // m/s, of the origin
    vec3 spin;        // rad/s
} HeadMotion;

// Where the head is at `time` (s).
HeadPose head_at(const RigidTrack *track, double time);

// Whether both poses are the same bit for bit.
bool head_is_same(const HeadPose *a, const HeadPose *b);

// The pose between `a` (t = 0) and `b` (t = 1): linear in the translation, slerp in the rotation.
HeadPose head_between(const HeadPose *a, const HeadPose *b, float t);

// Writes a pose in the form of uniform blocks: quaternion, and translation in xyz.
void head_put(vec4 rotation, vec4 translation, const HeadPose *pose);

// The rigid motion that takes hair at rest on the head at `from` to hair at rest on it at `to`.
HeadMotion head_motion_between(const HeadPose *from, const HeadPose *to);

// The head's velocity at time 0, which hair at rest on the head has too. False if it is zero;
// `motion` is then the identity.
bool head_starts_moving(const RigidTrack *track, HeadMotion *motion);

// The rule of --teleport in `run`, for a step in which the head goes from `from` to `to`. True if
// `pivot` (m, in the head's frame) moves by more than teleport_distance or the head turns by more
// than teleport_angle. Hair is then first carried from `from` to `*carried`, and the step begins
// there: `*carried` is `to` (carry), or differs from `to` by a move of the threshold's size
// (limit). False: nothing is carried.
bool head_jumps(const RunParams *run, const float pivot[3], const HeadPose *from,
                const HeadPose *to, HeadPose *carried);

// The middle of the box around the roots of all strands[count], in the head's frame (m).
void head_middle(float middle[3], const Strands *strands, uint32_t count);
