// SPDX-License-Identifier: MIT
#include "particle_solver.h"

static void fill(StepParams *uniforms, const SolverStep *step, const SectionParams *params)
{
    step_midpoint(uniforms, step, params);
}

static void define(ShaderDefine *defines, const SectionParams *params)
{
    defines[0] = (ShaderDefine){"STYLED", params->style > 0};
}

static const ParticleRecipe RECIPE = {
    .label = "sim_hybrid",
    .shader = "hybrid.comp",
    .most_in_registers = 32,
    .scratch = 2,
    .most_vertices = 12000, // five sweeps
    .fill = fill,
    .define = define,
};

const SolverType SOLVER_HYBRID = {
    .name = "hybrid",
    .summary = "tractrices as length constraint in two passes, velocities projected on what the "
               "shape allows",
    .lengths = "exact",
    .style = "position springs, --style, --style-stiffness",
    .most_stability = 1.6f,
    .calls = &PARTICLE_SOLVER,
    .recipes = {&RECIPE},
};
