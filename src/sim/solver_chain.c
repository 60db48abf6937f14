// SPDX-License-Identifier: MIT
#include "sim/particle_solver.h"

#include <math.h>

static void fill(StepParams *uniforms, const SolverStep *step, const SectionParams *params)
{
    (void)step;
    uniforms->own[0][0] = step_style_pull(uniforms, params);
    uniforms->own[0][1] = params->chain_bend * params->style / fmaxf(1 - params->style, 1e-6f);
}

static void define(ShaderDefine *defines, const SectionParams *params)
{
    defines[0] = (ShaderDefine){"STYLED", params->style > 0 && params->style_stiffness > 0};
    defines[1] = (ShaderDefine){"BENDS", params->style > 0 && params->chain_bend > 0};
}

static const ParticleRecipe RECIPE = {
    .label = "sim_chain",
    .shader = "sim/chain.comp",
    .most_in_registers = 16,
    .scratch = 2,
    .most_vertices = 7000, // nine sweeps
    .fill = fill,
    .define = define,
};

const SolverType SOLVER_CHAIN = {
    .name = "chain",
    .summary =
        "rigid segments by direct solves with implicit tension, second order in the step; curls "
        "keep their form by --chain-bend",
    .lengths = "exact",
    .style = "position springs, bending: --style, --style-stiffness, --chain-bend",
    .most_stability = 3.2f,
    .calls = &PARTICLE_SOLVER,
    .recipes = {&RECIPE},
};
