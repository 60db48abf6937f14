// SPDX-License-Identifier: MIT
#include "scene/driven_head.h"

#include <string.h>

// Replaces the body's track, starting from the pose that the track has at that time.
static void take_over(DrivenHead *head, SceneBody *body, double time)
{
    float rotation[4], translation[3], pivot[3];
    rigid_track_evaluate(&body->head, time, rotation, translation);
    for (int k = 0; k < 4; ++k) head->motion[1].rotation[k] = (double)rotation[k];
    for (int k = 0; k < 3; ++k) head->motion[1].translation[k] = (double)translation[k];
    memcpy(pivot, body->head.pivot, sizeof pivot);
    rigid_track_destroy(&body->head);
    memcpy(body->head.pivot, pivot, sizeof pivot);
    head->samples.motion = head->motion;
    body->head.samples = &head->samples;
}

void driven_head_move(DrivenHead *head, SceneBody *body, const RigidMotion *to, double before,
                      double after)
{
    if (!head->samples.motion) take_over(head, body, before);
    head->motion[0] = head->motion[1];
    head->motion[1] = *to;
    head->samples.times =
        (SampleTimes){.count = 2, .rate = 1 / (after - before), .start = before, .linear = true};
}
