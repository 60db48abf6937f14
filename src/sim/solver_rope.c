// SPDX-License-Identifier: MIT
#include "sim/particle_solver.h"

#include <math.h>
#include <string.h>

// A strand of at most this many vertices stays in registers for a whole step.
enum { MOST_IN_REGISTERS = 32 };

static bool is_bullet(const SectionParams *params)
{
    return strcmp(params->variant, "xpbd") != 0;
}

static int small_steps(const SectionParams *params)
{
    return is_bullet(params) ? 1 : params->rope_iterations;
}

static void fill(StepParams *uniforms, const SolverStep *step, const SectionParams *params)
{
    int count = small_steps(params);
    double h = step->dt * (double)params->rope_time_scale / count, c = (double)params->drag;
    uniforms->dt = (float)h;
    uniforms->own[0][0] = (float)count;
    uniforms->own[0][1] = (float)params->rope_iterations / (float)count;
    uniforms->own[0][2] = (float)pow(1 - (double)params->rope_damping, 1.0 / count);
    uniforms->own[0][3] = (float)((double)params->rope_compliance / (h * h));
    step_drag_factors(c, step->first ? h / 2 : h, &uniforms->decay, &uniforms->gain);
    uniforms->own[1][0] = uniforms->decay;
    uniforms->own[1][1] = uniforms->gain;
    uniforms->own[1][3] = step_style_pull(uniforms, params);
    step_drag_factors(c, h, &uniforms->decay, &uniforms->gain);
    uniforms->own[2][0] = step_style_pull(uniforms, params);
    uniforms->own[1][2] = params->stretch_drawn;
}

static void define(ShaderDefine *defines, const SectionParams *params)
{
    defines[0] = (ShaderDefine){"BULLET", is_bullet(params)};
    defines[1] = (ShaderDefine){"STYLED", params->style > 0};
}

static int phases(const SectionParams *params, const Hair *hair)
{
    (void)hair;
    return params->rope_iterations;
}

static Result check(const SolverSetup *setup, Error *error)
{
    if (is_bullet(setup->params) && setup->params->rope_compliance > 0)
        return error_set(error, RESULT_USAGE,
                         "rope_compliance: the rope as in Bullet has links of no compliance; "
                         "--variant xpbd has it");
    return RESULT_OK;
}

static const ParticleRecipe RECIPE = {
    .label = "sim_rope",
    .shader = "sim/rope.comp",
    .most_in_registers = MOST_IN_REGISTERS,
    .scratch = 2,
    .check = check,
    .fill = fill,
    .define = define,
    .phases = phases,
};

const SolverType SOLVER_ROPE = {
    .name = "rope",
    .summary = "position-based rope as in Bullet's soft bodies, or XPBD by small steps",
    .lengths = "within what its iterations allow; drawn exactly",
    .style = "position springs, --style, --style-stiffness",
    .variants = {"bullet", "xpbd"},
    .calls = &PARTICLE_SOLVER,
    .recipes = {&RECIPE},
};
