// SPDX-License-Identifier: MIT
// The direction of the automatic camera.
#pragma once

#include <cglm/types.h>

// Unit vectors in the world: the image's right and top, the direction from the target to the eye,
// and the axis of the turntable.
typedef struct Axes {
    vec3 right, top, back, up;
} Axes;

// The camera is in front (+z), 25 degrees to the side and 10 degrees above. `camera_up`:
// run.camera_up.
void axes_find(Axes *axes, const float camera_up[3]);
