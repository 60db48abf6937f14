// SPDX-License-Identifier: MIT
#include "particle_solver.h"

static void fill(StepParams *uniforms, const SolverStep *step, const SectionParams *params)
{
    (void)step;
    uniforms->own[0][0] = step_style_pull(uniforms, params);
}

static void define(ShaderDefine *defines, const SectionParams *params)
{
    defines[0] = (ShaderDefine){"STYLED", params->style > 0};
}

static const ParticleRecipe RECIPE = {
    .label = "sim_chain",
    .shader = "chain.comp",
    .most_in_registers = 16,
    .scratch = 2,
    .most_vertices = 7000, // nine sweeps
    .fill = fill,
    .define = define,
};

const SolverType SOLVER_CHAIN = {
    .name = "chain",
    .summary = "rigid segments by direct solves with implicit tension: the accurate one, second "
               "order in the step",
    .lengths = "exact",
    .style = "position springs, --style, --style-stiffness",
    .most_stability = 3.2f,
    .calls = &PARTICLE_SOLVER,
    .recipes = {&RECIPE},
};
