// SPDX-License-Identifier: MIT
#include "sim/solver.h"

#include "glsl/sim/dftl_params.h"

static void fill(void *block, StepParams *uniforms, const SolverStep *step,
                 const SectionParams *params)
{
    (void)step;
    *(DftlParams *)block = (DftlParams){
        .spring = step_style_spring(uniforms, (double)uniforms->dt, params),
        .damping = params->ftl_damping,
    };
}

static const SolverRecipe RECIPE = {
    .label = "sim_dftl",
    .shader = "sim/dftl.comp",
    .params_size = sizeof(DftlParams),
    .fill = fill,
    .along = step_spring_along,
};

const SolverType SOLVER_DFTL = {
    .name = "dftl",
    .summary = "dynamic follow-the-leader (Mueller et al. 2012): lengths exact in one pass, "
               "strongly damped",
    .lengths = "exact",
    .style = "position springs, --style, --style-stiffness",
    .recipes = {&RECIPE},
};
