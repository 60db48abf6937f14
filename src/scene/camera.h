// SPDX-License-Identifier: MIT
// The camera and the lights of each frame.
#pragma once

#include "scene/environment.h"
#include "scene/outline.h"
#include "scene/scene.h"

#include <cglm/types.h>

// A camera, right-handed: x right, y up, z towards the viewer in `view`; clip space as OpenGL's.
typedef struct View {
    mat4 view;                         // world -> eye, rigid, metres
    mat4 projection;                   // eye -> clip, perspective
    vec3 eye;                          // m, in the world
    float fov;                         // vertical, radians
    float near_distance, far_distance; // m, > 0
} View;

// The camera of frame `frame` (0 .. run.frames - 1) for an image of run.size. Keyframes of eye,
// target and fov win over the parameters; what is automatic comes from the framing. The turntable
// turns the eye about the axis through the target along camera_up, counter-clockwise seen from its
// tip, by camera_turntable_deg. Any finite input gives a finite camera: an eye on the
// target looks along -z, an up direction along the line of sight is replaced.
void camera_view(View *view, const Scene *scene, const Framing *framing, int frame);

// Distances before the eye's plane, m, between which hair and mesh lie in all frames, with some
// room on both sides. Found at 64 frames of the sequence. Hair that swings out of its outline may
// leave them.
void camera_depth_range(float range[2], const Scene *scene, const Framing *framing);

// Where the environment's axes point in frame `frame`: turned by run.environment_turn and, with
// run.turn_lights, with the eye.
EnvironmentAxes camera_environment(const Scene *scene, int frame);

// The lights of frame `frame`: the scene's, or with run.turn_lights turned with the eye.
void camera_lights(Light lights[SCENE_MAX_LIGHTS], const Scene *scene, const Framing *framing,
                   int frame);

// The turntable's angle at frame `frame` (>= 0; run.frames is the end of the first round), degrees,
// as far as a camera can tell: 0 at frames 0 and run.frames of whole turns, exactly.
//
// The speed rises from 0 over the first run.ease_in of the sequence, is constant, and falls to 0
// over its last run.ease_out, as 3 s^2 - 2 s^3, so that the acceleration is continuous, too.
double camera_turntable_deg(const RunParams *run, int frame);
