// SPDX-License-Identifier: MIT
#include "sim/particle_solver.h"

static void fill(StepParams *uniforms, const SolverStep *step, const SectionParams *params)
{
    (void)step;
    uniforms->own[0][0] = step_style_pull(uniforms, params);
    uniforms->own[0][1] = params->ftl_damping;
}

static void define(ShaderDefine *defines, const SectionParams *params)
{
    defines[0] = (ShaderDefine){"STYLED", params->style > 0};
}

static const ParticleRecipe RECIPE = {
    .label = "sim_dftl",
    .shader = "sim/dftl.comp",
    .fill = fill,
    .define = define,
};

const SolverType SOLVER_DFTL = {
    .name = "dftl",
    .summary = "dynamic follow-the-leader (Mueller et al. 2012): lengths exact in one pass, "
               "strongly damped",
    .lengths = "exact",
    .style = "position springs, --style, --style-stiffness",
    .calls = &PARTICLE_SOLVER,
    .recipes = {&RECIPE},
};
