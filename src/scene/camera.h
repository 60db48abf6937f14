// SPDX-License-Identifier: MIT
// The camera and the lights of each frame.
#pragma once

#include "scene/environment.h"
#include "scene/outline.h"
#include "scene/scene.h"

#include <cglm/types.h>

// A right-handed camera: x right, y up, z towards the viewer in `view`; clip space as in OpenGL.
typedef struct View {
    mat4 view;                         // world -> eye, rigid, metres
    mat4 projection;                   // eye -> clip, perspective
    vec3 eye;                          // m, in the world
    float fov;                         // vertical, radians
    float near_distance, far_distance; // m, > 0
} View;

// The camera of frame `frame` (0 .. run.frames - 1) for an image of run.size. Tracks of eye,
// target and fov override the parameters; automatic values come from the framing. The turntable
// turns the eye by camera_turntable_deg about the axis through the target along camera_up,
// counter-clockwise as seen from its tip. Any finite input gives a finite camera: if the eye is at
// the target, it looks along -z; an up direction along the line of sight is replaced.
void camera_view(View *view, const Scene *scene, const Framing *framing, int frame);

// The range of distances from the eye's plane (m) that contains hair and mesh in all frames, with
// some margin on both sides. Computed at 64 frames of the sequence. Hair that swings beyond its
// outline may leave the range.
void camera_depth_range(float range[2], const Scene *scene, const Framing *framing);

// The environment's axes in frame `frame`: turned by run.environment_turn and, with
// run.turn_lights, together with the eye.
EnvironmentAxes camera_environment(const Scene *scene, int frame);

// The lights of frame `frame`: those of the scene, turned together with the eye if run.turn_lights
// is set.
void camera_lights(Light lights[SCENE_MAX_LIGHTS], const Scene *scene, const Framing *framing,
                   int frame);

// The turntable's angle at frame `frame` (>= 0; run.frames ends the first turn) in degrees, reduced
// to what a camera can distinguish: it is exactly 0 at frames 0 and run.frames of whole turns.
//
// The speed rises from 0 during the first run.ease_in of the sequence, is then constant, and falls
// to 0 during its last run.ease_out, as 3 s^2 - 2 s^3, so the acceleration is continuous, too.
double camera_turntable_deg(const RunParams *run, int frame);
