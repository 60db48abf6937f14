// SPDX-License-Identifier: MIT
#include "sim/solver.h"

#include "glsl/sim/chain_params.h"

static void fill(void *block, StepParams *uniforms, const SolverStep *step,
                 const SectionParams *params)
{
    (void)step;
    *(ChainParams *)block =
        (ChainParams){.spring = step_style_spring(uniforms, (double)uniforms->dt, params)};
}

static const SolverRecipe RECIPE = {
    .label = "sim_chain",
    .shader = "sim/chain.comp",
    .shape = STEP_CHAIN,
    .scratch = 2,
    .most_vertices = 7000, // 9 sweeps fit the 65535 iterations of CPU drivers
    .params_size = sizeof(ChainParams),
    .fill = fill,
    .along = step_spring_along,
};

const SolverType SOLVER_CHAIN = {
    .name = "chain",
    .summary = "every particle is simulated, a direct solve keeps the lengths; second order in the "
               "step",
    .lengths = "exact",
    .style = "position springs, --style, --style-stiffness",
    .most_stability = 3.2f,
    .recipes = {&RECIPE},
};
