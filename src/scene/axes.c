// SPDX-License-Identifier: MIT
#include "scene/axes.h"

#include <cglm/cglm.h>

#include <math.h>
#include <string.h>

static const float SIDE_DEG = 25, ABOVE_DEG = 10;

void axes_find(Axes *axes, const float camera_up[3])
{
    memcpy(axes->up, camera_up, sizeof(vec3));
    glm_vec3_normalize(axes->up);
    if (glm_vec3_norm(axes->up) < 0.5f) glm_vec3_copy((vec3){0, 1, 0}, axes->up);
    vec3 front = {0, 0, 1};
    if (fabsf(axes->up[2]) > 0.99f) glm_vec3_copy((vec3){0, -1, 0}, front);
    glm_vec3_crossn(axes->up, front, axes->right);
    glm_vec3_cross(axes->right, axes->up, axes->back);
    glm_vec3_rotate(axes->right, glm_rad(SIDE_DEG), axes->up);
    glm_vec3_rotate(axes->back, glm_rad(SIDE_DEG), axes->up);
    glm_vec3_rotate(axes->back, -glm_rad(ABOVE_DEG), axes->right);
    glm_vec3_cross(axes->back, axes->right, axes->top);
}
