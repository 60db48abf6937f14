// SPDX-License-Identifier: MIT
#include "particle_solver.h"

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
    uniforms->own[0][0] = thesis ? 0 : step_style_pull(uniforms, params);
    uniforms->own[0][1] = thesis ? params->style_stiffness * style / (1 - style) : 0;
    uniforms->passes = step->shuffle;
}

static void define(ShaderDefine *defines, const SectionParams *params)
{
    defines[0] = (ShaderDefine){"STYLED", params->style > 0 && !is_thesis(params)};
    defines[1] = (ShaderDefine){"THESIS", is_thesis(params)};
}

static const ParticleRecipe RECIPE = {
    .label = "sim_emulation",
    .shader = "emulation.comp",
    .most_in_registers =
        32, // shared memory: 64 lanes of a GPU fill the 32 KiB that every driver has
    .scratch = 1,
    .most_vertices = 240, // each particle pulls all others
    .fill = fill,
    .define = define,
};

static const char *caution(const SectionParams *params)
{
    return is_thesis(params)
               ? "the published rule gains energy: hair with little drag speeds up by itself"
               : NULL;
}

const SolverType SOLVER_EMULATION = {
    .name = "emulation",
    .summary = "every particle pulls the strand along as tractrices, O(n^2); thesis: as published, "
               "unstable without much drag",
    .variants = {"projected", "thesis"},
    .caution = caution,
    .most_stability = 1.6f,
    .calls = &PARTICLE_SOLVER,
    .recipes = {&RECIPE},
};
