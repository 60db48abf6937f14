// SPDX-License-Identifier: MIT
#include "sim/solver.h"

#include "glsl/sim/rope_params.h"

#include <math.h>
#include <string.h>

static bool is_bullet(const SectionParams *params)
{
    return strcmp(params->variant, "xpbd") != 0;
}

static int small_steps(const SectionParams *params)
{
    return is_bullet(params) ? 1 : params->rope_iterations;
}

static void fill(void *block, StepParams *uniforms, const SolverStep *step,
                 const SectionParams *params)
{
    int count = small_steps(params);
    double h = step->dt * (double)params->rope_time_scale / count, c = (double)params->drag;
    RopeParams *rope = block;
    uniforms->dt = (float)h;
    rope->small_steps = count;
    rope->sweeps = params->rope_iterations / count;
    rope->kept = (float)pow(1 - (double)params->rope_damping, 1.0 / count);
    rope->softness = (float)((double)params->rope_compliance / (h * h));
    rope->stretch_drawn = params->stretch_drawn;
    step_drag_factors(c, step->first ? h / 2 : h, &uniforms->decay, &uniforms->gain);
    rope->first_decay = uniforms->decay;
    rope->first_gain = uniforms->gain;
    rope->first_spring = step_style_spring(uniforms, (double)uniforms->dt, params);
    step_drag_factors(c, h, &uniforms->decay, &uniforms->gain);
    rope->spring = step_style_spring(uniforms, (double)uniforms->dt, params);
}

static void define(ShaderDefine *defines, const SectionParams *params)
{
    defines[0] = (ShaderDefine){"BULLET", is_bullet(params)};
}

static int phases(const SectionParams *params, const Hair *hair)
{
    (void)hair;
    return params->rope_iterations;
}

static void along(float texel[4], const void *block, const void *mean, const SectionParams *there)
{
    const RopeParams *rope = block;
    (void)mean, (void)there;
    texel[0] = rope->first_decay, texel[1] = rope->first_gain;
    texel[2] = rope->first_spring.pull, texel[3] = rope->spring.pull;
}

static Result check(const SolverSetup *setup, Error *error)
{
    if (is_bullet(setup->params) && setup->params->rope_compliance > 0)
        return error_set(
            error, RESULT_USAGE,
            "--rope-compliance: has no effect with --variant bullet: expected --variant xpbd");
    return RESULT_OK;
}

static const SolverRecipe RECIPE = {
    .label = "sim_rope",
    .shader = "sim/rope.comp",
    .shape = STEP_ROPE,
    .scratch = 2,
    .check = check,
    .params_size = sizeof(RopeParams),
    .fill = fill,
    .define = define,
    .phases = phases,
    .along = along,
};

const SolverType SOLVER_ROPE = {
    .name = "rope",
    .summary = "position-based dynamics as in Bullet's soft bodies; variant xpbd: small steps "
               "instead of many passes",
    .lengths = "strands stretch, the less the more iterations; drawn with exact lengths",
    .style = "position springs, --style, --style-stiffness",
    .variants = {"bullet", "xpbd"},
    .recipes = {&RECIPE},
};
