// SPDX-License-Identifier: MIT
#include "sim/shelter.h"

#include <cglm/cglm.h>

#include <math.h>

void shelter_middle(float middle[3], const Scene *scene, const Strands *strands)
{
    float low[3] = {INFINITY, INFINITY, INFINITY}, high[3] = {-INFINITY, -INFINITY, -INFINITY};
    for (uint32_t i = 0; i < scene->section_count; ++i)
        for (uint32_t s = 0; s < strands[i].strand_count; ++s)
            for (int k = 0; k < 3; ++k) {
                float at = strands[i].position[strands[i].first[s]][k];
                low[k] = fminf(low[k], at);
                high[k] = fmaxf(high[k], at);
            }
    for (int k = 0; k < 3; ++k) middle[k] = high[k] >= low[k] ? 0.5f * (low[k] + high[k]) : 0;
}

static void carry(const HeadPose *head, const float point[3], vec3 carried)
{
    glm_quat_rotatev((float *)head->rotation, (float *)point, carried);
    glm_vec3_add((float *)head->translation, carried, carried);
}

void shelter_fill(SolverStep *step, const float middle[3], float share)
{
    vec3 old = {0};
    carry(&step->head_old, middle, old);
    carry(&step->head, middle, step->shelter);
    step->shelter[3] = share;
    for (int k = 0; k < 3; ++k)
        step->head_velocity[k] = (float)((double)(step->shelter[k] - old[k]) / step->dt);
}
