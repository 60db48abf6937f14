// SPDX-License-Identifier: MIT
#include "sim/particle_solver.h"

#include <stdio.h>
#include <string.h>

static bool is_thesis(const SectionParams *params)
{
    return strcmp(params->variant, "thesis") == 0;
}

static void fill(StepParams *uniforms, const SolverStep *step, const SectionParams *params)
{
    float style = params->style < 1 ? params->style : 0.999999f;
    bool thesis = is_thesis(params);
    if (!thesis) step_midpoint(uniforms, step, params);
    uniforms->own[0][1] = thesis ? params->style_stiffness * style / (1 - style) : 0;
    uniforms->passes = 1; // the order of every step: with a new one each, hair on a sphere trembles
}

static void define(ShaderDefine *defines, const SectionParams *params)
{
    defines[0] = (ShaderDefine){"STYLED", params->style > 0 && !is_thesis(params)};
    defines[1] = (ShaderDefine){"THESIS", is_thesis(params)};
}

// As many dispatches as let each turn MOST_LINKS links (emulation.comp), of the places in a random
// order, whose number is a power of two.
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

static const ParticleRecipe RECIPE = {
    .label = "sim_emulation",
    .shader = "sim/emulation.comp",
    .most_in_registers = 32,
    .scratch = 2,
    .most_vertices = 5000, // four sweeps beside a dispatch's links
    .fill = fill,
    .define = define,
    .phases = phases,
};

static const char *caution(const SectionParams *params)
{
    return is_thesis(params)
               ? "the published rule gains energy: hair with little drag speeds up by itself"
               : NULL;
}

const SolverType SOLVER_EMULATION = {
    .name = "emulation",
    .summary =
        "every particle pulls the strand along as tractrices, O(n^2), second order; thesis: as "
        "published, unstable without much drag",
    .variants = {"projected", "thesis"},
    .caution = caution,
    .most_stability = 1.6f, // as hybrid's
    .calls = &PARTICLE_SOLVER,
    .recipes = {&RECIPE},
};
