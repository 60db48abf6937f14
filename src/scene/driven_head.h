// SPDX-License-Identifier: MIT
// A head that goes where somebody says, frame by frame, instead of along the scene's track.
#pragma once

#include "scene/scene.h"

// Zeroed: the scene's track moves the head.
typedef struct DrivenHead {
    RigidMotion motion[2]; // at the beginning and at the end of the frame that is on
    RigidSamples samples;  // of them
} DrivenHead;

// Goes on: the head is at `to` at the time `after` (s), and gets there evenly from where it is at
// `before`: a screw motion. From the first time on the scene's head is this one, which stays where
// it is.
void driven_head_move(DrivenHead *head, Scene *scene, const RigidMotion *to, double before,
                      double after);
