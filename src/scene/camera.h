// SPDX-License-Identifier: MIT
// Where the picture is taken from in each frame.
#pragma once

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

// The camera of frame `frame` (0 .. run.frames - 1) for a picture of run.size. Keyframes of eye,
// target and fov win over the parameters; what is automatic comes from the framing. The turntable
// turns the eye about the axis through the target along camera_up, counter-clockwise seen from its
// tip, by turntable_angle_deg. Any finite input gives a finite camera: an eye on the
// target looks along -z, an up direction along the line of sight is replaced.
void camera_view(View *view, const Scene *scene, const Framing *framing, int frame);

// The lights of frame `frame`: the scene's, or with run.turn_lights turned with the eye.
void camera_lights(Light lights[SCENE_MAX_LIGHTS], const Scene *scene, const Framing *framing,
                   int frame);
