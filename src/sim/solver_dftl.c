// SPDX-License-Identifier: MIT
#include "sim/solver.h"

#include "glsl/sim/dftl_params.h"

#include <string.h>

static void fill(void *block, StepParams *uniforms, const SolverStep *step,
                 const SectionParams *params)
{
    (void)step;
    *(DftlParams *)block = (DftlParams){
        .spring = step_style_spring(uniforms, (double)uniforms->dt, params),
        .damping = params->ftl_damping,
    };
}

static void define(ShaderDefine *defines, const SectionParams *params)
{
    defines[0] = (ShaderDefine){"GUARDED", strcmp(params->variant, "mueller") != 0};
}

static const SolverRecipe RECIPE = {
    .label = "sim_dftl",
    .shader = "sim/dftl.comp",
    .most_vertices = 32000, // 2 sweeps fit the 65535 iterations of CPU drivers
    .params_size = sizeof(DftlParams),
    .fill = fill,
    .along = step_spring_along,
    .define = define,
};

const SolverType SOLVER_DFTL = {
    .name = "dftl",
    .summary = "dynamic follow-the-leader (Mueller et al. 2012): one pass from root to tip keeps "
               "the lengths; strongly damped",
    .lengths = "exact",
    .style = "position springs, --style, --style-stiffness",
    .variants = {"steady", "mueller"},
    .recipes = {&RECIPE},
};
