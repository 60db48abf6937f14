// SPDX-License-Identifier: MIT
#include "sim/solver.h"

#include "glsl/sim/hybrid_params.h"

static void fill(void *block, StepParams *uniforms, const SolverStep *step,
                 const SectionParams *params)
{
    *(HybridParams *)block = (HybridParams){.spring = step_midpoint(uniforms, step, params)};
}

static const SolverRecipe RECIPE = {
    .label = "sim_hybrid",
    .shader = "sim/hybrid.comp",
    .shape = STEP_HYBRID,
    .scratch = 2,
    .most_vertices = 12000, // 5 sweeps fit the 65535 iterations of CPU drivers
    .params_size = sizeof(HybridParams),
    .fill = fill,
    .along = step_spring_along,
};

const SolverType SOLVER_HYBRID = {
    .name = "hybrid",
    .summary = "every particle is simulated, two passes of tractrices keep the lengths; second "
               "order in the step, never gains energy",
    .lengths = "exact",
    .style = "position springs, --style, --style-stiffness",
    // It stays calm at any value, but accuracy suffers: 32 particles at 60 Hz (3.2) are off by 0.25
    // of their length, at 1.6 by 0.015.
    .most_stability = 1.6f,
    .recipes = {&RECIPE},
};
