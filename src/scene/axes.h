// SPDX-License-Identifier: MIT
// How the automatic camera looks.
#pragma once

#include <cglm/types.h>

// Unit vectors in the world: to the right and to the top of the image, from the target to the eye,
// and the axis of the turntable.
typedef struct Axes {
    vec3 right, top, back, up;
} Axes;

// In front (+z), 25 degrees to the side and 10 degrees above. `camera_up`: run.camera_up.
void axes_find(Axes *axes, const float camera_up[3]);
