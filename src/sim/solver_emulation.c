// SPDX-License-Identifier: MIT
#include "sim/solver.h"

#include "glsl/sim/emulation_params.h"

#include <string.h>

static bool is_thesis(const SectionParams *params)
{
    return strcmp(params->variant, "thesis") == 0;
}

static void fill(void *block, StepParams *uniforms, const SolverStep *step,
                 const SectionParams *params)
{
    EmulationParams *emulation = block;
    emulation->order_seed = 1; // the same order in every step; with changing orders, hair on a
                               // sphere trembles
    if (is_thesis(params))     // uses an explicit spring
        emulation->spring.stiffness = step_style_spring(uniforms, step->dt, params).stiffness;
    else
        emulation->spring = step_midpoint(uniforms, step, params);
}

static void define(ShaderDefine *defines, const SectionParams *params)
{
    defines[0] = (ShaderDefine){"THESIS", is_thesis(params)};
}

// The number of dispatches, so that each turns at most MOST_LINKS links (emulation.comp). The
// particles of a strand are visited in a random order, whose length is a power of two.
static int phases(const SectionParams *params, const Hair *hair)
{
    enum { MOST_LINKS = 40000 };
    (void)params;
    int most = 1;
    for (uint32_t i = 0; i < hair->batch_count; ++i) {
        int count = (int)hair->batches[i].vertex_count - 1, places = 2;
        while (places < count) places *= 2;
        int needed = (places + MOST_LINKS / count - 1) / (MOST_LINKS / count);
        if (needed > most) most = needed;
    }
    return most;
}

static const SolverRecipe RECIPE = {
    .label = "sim_emulation",
    .shader = "sim/emulation.comp",
    .shape = STEP_EMULATION,
    .scratch = 2,
    .most_vertices = 5000, // 4 sweeps and MOST_LINKS fit 65535 iterations
    .params_size = sizeof(EmulationParams),
    .fill = fill,
    .define = define,
    .phases = phases,
    .along = step_spring_along,
};

static const char *caution(const SectionParams *params)
{
    return is_thesis(params)
               ? "the published rule gains energy: hair with little drag speeds up by itself"
               : NULL;
}

const SolverType SOLVER_EMULATION = {
    .name = "emulation",
    .summary = "every particle pulls the strand behind it (tractrices); time grows with the square "
               "of their number; variant thesis: as published, unstable without much drag",
    .lengths = "exact",
    .style = "position springs, --style, --style-stiffness",
    .variants = {"projected", "thesis"},
    .caution = caution,
    .most_stability = 1.6f, // as hybrid
    .published = "thesis",
    .recipes = {&RECIPE},
};
