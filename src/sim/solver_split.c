// SPDX-License-Identifier: MIT
#include "sim/solver.h"

#include "glsl/sim/split_params.h"

#include <string.h>

static bool is_thesis(const SectionParams *params)
{
    return strcmp(params->variant, "thesis") == 0;
}

static void fill(void *block, StepParams *uniforms, const SolverStep *step,
                 const SectionParams *params)
{
    (void)uniforms;
    (void)step;
    *(SplitParams *)block = (SplitParams){.pulls = is_thesis(params) ? 2 : 4};
}

static void define(ShaderDefine *defines, const SectionParams *params)
{
    bool thesis = is_thesis(params), dragged = strcmp(params->variant, "dragged") == 0;
    defines[0] = (ShaderDefine){"THESIS", thesis};
    defines[1] = (ShaderDefine){"DRAGGED", thesis || dragged};
}

// The pose reads the style.
static void along(float texel[4], const void *block, const void *mean, const SectionParams *there)
{
    (void)block, (void)mean;
    texel[0] = there->style;
}

static const SolverRecipe RECIPE = {
    .label = "sim_split",
    .shader = "sim/split.comp",
    .state = SOLVER_SEGMENTS,
    .shape = STEP_SPLIT,
    .most_vertices = 10000, // 6 loops (span, 4 pulls, renormalisation) fit 65535
    .carried = 1,
    .params_size = sizeof(SplitParams),
    .fill = fill,
    .define = define,
    .along = along,
};

const SolverType SOLVER_SPLIT = {
    .name = "split",
    .summary = "only the tip is simulated, the strand trails behind it (tractrices); cheap, "
               "without waves along the strand",
    .lengths = "exact",
    .style = "mixed into the drawn hair, --style",
    .variants = {"ball", "dragged", "thesis"},
    .published = "thesis",
    .recipes = {&RECIPE},
};
