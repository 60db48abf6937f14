// SPDX-License-Identifier: MIT
// What the head does to all hair beyond pulling at the roots: it may move from the first instant
// on, and it may jump.
#pragma once

#include "scene/scene.h"
#include "sim/carry.h"

// Where the head is at `time` (s).
HeadPose head_motion_pose(const Scene *scene, double time);

// The velocity that the head has at time 0: hair at rest on it has that too. False if it has none;
// then `motion` changes nothing.
bool head_motion_start(const Scene *scene, CarryMotion *motion);

// The rule of --teleport for a step in which the head goes from `from` to `to`: if its pivot moves
// by more than teleport_distance or it turns by more than teleport_angle, hair is first carried
// along to `*carried` (all the way, or but for a move of that size), from where the step begins.
// False: nothing is carried.
bool head_motion_jumps(const Scene *scene, const HeadPose *from, const HeadPose *to,
                       HeadPose *carried);
