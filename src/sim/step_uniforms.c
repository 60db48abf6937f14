// SPDX-License-Identifier: MIT
#include "sim/step_uniforms.h"

#include <math.h>
#include <string.h>

void step_drag_factors(double c, double h, float *decay, float *gain)
{
    *decay = (float)exp(-c * h);
    *gain = c > 0 ? (float)(-expm1(-c * h) / c) : (float)h;
}

static void set_pose(vec4 rotation, vec4 translation, const HeadPose *pose)
{
    memcpy(rotation, pose->rotation, sizeof pose->rotation);
    memcpy(translation, pose->translation, sizeof pose->translation);
}

StepParams step_uniforms(const SolverStep *step, const SectionParams *params)
{
    StepParams uniforms = {
        .dt = (float)step->dt,
        .drag = params->drag,
    };
    set_pose(uniforms.head_rotation_old, uniforms.head_translation_old, &step->head_old);
    set_pose(uniforms.head_rotation, uniforms.head_translation, &step->head);
    memcpy(uniforms.gravity, step->gravity, sizeof step->gravity);
    for (int i = 0; i < 4; ++i) memcpy(uniforms.wind[i], step->wind[i], sizeof step->wind[i]);
    memcpy(uniforms.shelter, step->shelter, sizeof step->shelter);
    memcpy(uniforms.head_velocity, step->head_velocity, sizeof step->head_velocity);
    step_drag_factors((double)params->drag, step->first ? step->dt / 2 : step->dt, &uniforms.decay,
                      &uniforms.gain);
    return uniforms;
}

float step_style_pull(const StepParams *uniforms, const SectionParams *params)
{
    double w = (double)params->style * (double)params->style_stiffness * (double)uniforms->dt *
               (double)uniforms->gain;
    return w > 0 ? (float)(w / (1 - (double)params->style + w)) : 0;
}

void step_midpoint(StepParams *uniforms, const SolverStep *step, const SectionParams *params)
{
    const double most_style = 0.999999; // springs of 1 would be infinitely stiff
    double h = step->dt / 2, c = (double)params->drag,
           style = fmin((double)params->style, most_style);
    double k = (double)params->style_stiffness * style / (1 - style);
    step_drag_factors(c, h, &uniforms->decay, &uniforms->gain);
    // Two half kicks about a spring at rest add (1 + e^{-ch})/(1 + e^{-2ch}) gain each: as much of
    // the spring keeps the balance exact.
    double decay = (double)uniforms->decay,
           z = k * h * (double)uniforms->gain * (1 + decay) / (1 + decay * decay);
    double keep = 1 / (1 + z + z * z / (1 + z));
    uniforms->own[1][0] = (float)keep;
    uniforms->own[1][1] = (float)(keep * z / h);
    uniforms->own[1][2] = (float)k;
}

uint32_t step_group_size(const Gpu *gpu)
{
    return gpu->software ? 8 : 64;
}

uint32_t step_group_count(uint32_t count, uint32_t group_size, uint32_t strands_per_lane)
{
    uint32_t strands = group_size * strands_per_lane;
    return (count + strands - 1) / strands;
}

enum { MOST_REGISTER_VARIANTS = 2 };

bool step_fits_registers(const Hair *hair, uint32_t most)
{
    uint32_t counts = 0, last = 0;
    for (uint32_t i = 0; i < hair->batch_count; ++i) {
        if (hair->batches[i].vertex_count > most) return false;
        counts += hair->batches[i].vertex_count != last;
        last = hair->batches[i].vertex_count;
    }
    return counts <= MOST_REGISTER_VARIANTS;
}
