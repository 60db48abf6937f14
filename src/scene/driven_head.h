// SPDX-License-Identifier: MIT
// A body's head that the caller moves frame by frame, instead of the body's track.
#pragma once

#include "scene/scene.h"

// Zeroed: the body's track moves the head.
typedef struct DrivenHead {
    RigidMotion motion[2]; // at the start and at the end of the current frame
    RigidSamples samples;  // made of `motion`
} DrivenHead;

// The head is at `to` at time `after` (s) and moves there evenly, by a screw motion, from where it
// is at time `before`. From the first call on, this replaces the body's track; afterwards the head
// stays where it is.
void driven_head_move(DrivenHead *head, SceneBody *body, const RigidMotion *to, double before,
                      double after);
