// SPDX-License-Identifier: MIT
// The head's motion, and what it does to all hair beyond pulling at the roots: it may move from the
// first instant on, and it may jump.
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
HeadPose head_at(const Scene *scene, double time);

// Whether both are the same to the bit.
bool head_is_same(const HeadPose *a, const HeadPose *b);

// The pose after the share t (0 .. 1) of a way: translation straight, rotation by slerp.
HeadPose head_between(const HeadPose *a, const HeadPose *b, float t);

// As uniform blocks have it: xyz of `translation`.
void head_put(vec4 rotation, vec4 translation, const HeadPose *pose);

// The rigid motion that takes hair at rest on the head at `from` to hair at rest on it at `to`.
HeadMotion head_motion_between(const HeadPose *from, const HeadPose *to);

// The velocity that the head has at time 0: hair at rest on it has that too. False if it has none;
// then `motion` changes nothing.
bool head_starts_moving(const Scene *scene, HeadMotion *motion);

// The rule of --teleport for a step in which the head goes from `from` to `to`: if its pivot moves
// by more than teleport_distance or it turns by more than teleport_angle, hair is first carried
// along to `*carried` (all the way, or but for a move of that size), from where the step begins.
// False: nothing is carried.
bool head_jumps(const Scene *scene, const HeadPose *from, const HeadPose *to, HeadPose *carried);

// The middle of the box around the roots of all sections (strands[scene->section_count]), in the
// head's frame (m).
void head_middle(float middle[3], const Scene *scene, const Strands *strands);
