// SPDX-License-Identifier: MIT
#include "sim/particle_solver.h"

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
    .shader = "sim/hybrid.comp",
    .most_in_registers = 32,
    .scratch = 2,
    .most_vertices = 12000, // five sweeps
    .fill = fill,
    .define = define,
};

const SolverType SOLVER_HYBRID = {
    .name = "hybrid",
    .summary = "tractrices as length constraint in two passes about an implicit midpoint rule: "
               "second order, energy never rises",
    .lengths = "exact",
    .style = "position springs, --style, --style-stiffness",
    .most_stability = 1.6f, // it is calm at any; 32 particles at 60 Hz (3.2) are off by 0.25 of
                            // their length, at 1.6 by 0.015
    .calls = &PARTICLE_SOLVER,
    .recipes = {&RECIPE},
};
