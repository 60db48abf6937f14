// SPDX-License-Identifier: MIT
#include "sim/along.h"

#include <stdlib.h>
#include <string.h>

bool along_varies(const SolverRecipe *recipe, const SectionParams *params)
{
    return recipe->along && (params->style_along.count || params->style_stiffness_along.count ||
                             params->drag_along.count || params->gravity_share_along.count ||
                             params->youngs_modulus_along.count || params->hair_radius_along.count);
}

Result along_create(Along *along, const SolverRecipe *recipe, const Hair *hair,
                    const uint32_t *leads, const SectionParams *params, const GpuLimits *limits,
                    Error *error)
{
    uint32_t longest = 0;
    for (uint32_t i = 0; i < hair->batch_count; ++i)
        if (hair->batches[i].vertex_count > longest) longest = hair->batches[i].vertex_count;
    *along = (Along){.hair = hair,
                     .params = params,
                     .recipe = recipe,
                     .leads = leads,
                     .tables = calloc((size_t)hair->batch_count + 1, sizeof *along->tables),
                     .texels = malloc(2 * ((size_t)longest + 1) * sizeof *along->texels),
                     .block = malloc(recipe->params_size + 1)};
    if (!along->tables || !along->texels || !along->block)
        return error_set(error, RESULT_FAILED, "no memory for a solver");
    for (uint32_t i = 0; i < hair->batch_count; ++i)
        TRY(gpu_buffer_create(&along->tables[i], limits, "parameters along the strand",
                              (int64_t)(2 * hair->batches[i].vertex_count * sizeof *along->texels),
                              NULL, GL_RGBA32F, error));
    return RESULT_OK;
}

void along_destroy(Along *along)
{
    for (uint32_t i = 0; along->tables && i < along->hair->batch_count; ++i)
        gpu_buffer_destroy(&along->tables[i]);
    free(along->tables);
    free(along->texels);
    free(along->block);
    *along = (Along){0};
}

SectionParams along_params_at(const SectionParams *params, double share)
{
    SectionParams at = *params;
    at.style = profile_at(params->style, &params->style_along, share);
    at.style_stiffness = profile_at(params->style_stiffness, &params->style_stiffness_along, share);
    at.drag = profile_at(params->drag, &params->drag_along, share);
    at.youngs_modulus = profile_at(params->youngs_modulus, &params->youngs_modulus_along, share);
    at.hair_radius = profile_at(params->hair_radius, &params->hair_radius_along, share);
    at.gravity_share = profile_at(params->gravity_share, &params->gravity_share_along, share);
    return at;
}

static void fill_vertex(Along *along, const SolverStep *step, const void *mean, double share,
                        float own[4], float forces[4])
{
    const SolverRecipe *recipe = along->recipe;
    const SectionParams at = along_params_at(along->params, share);
    StepParams uniforms = step_uniforms(step, &at);
    memset(along->block, 0, recipe->params_size);
    if (recipe->fill) recipe->fill(along->block, &uniforms, step, &at);
    memset(own, 0, 4 * sizeof *own);
    recipe->along(own, along->block, mean, &at);
    forces[0] = uniforms.decay, forces[1] = uniforms.gain, forces[2] = uniforms.drag;
    forces[3] =
        along->params->gravity_share > 0 ? at.gravity_share / along->params->gravity_share : 0;
}

void along_fill(Along *along, const SolverStep *step, const void *mean)
{
    if (!along->hair || (along->dt == step->dt && along->first == step->first &&
                         along->stamp == step->params_stamp))
        return;
    along->stamp = step->params_stamp;
    along->dt = step->dt, along->first = step->first;
    for (uint32_t i = 0; i < along->hair->batch_count; ++i) {
        uint32_t n = along->hair->batches[i].vertex_count, lead = along->leads[i];
        memset(along->texels, 0, 2 * n * sizeof *along->texels);
        for (uint32_t j = lead; j < n; ++j)
            fill_vertex(along, step, mean, (double)j / (n - 1), along->texels[2 * (j - lead)],
                        along->texels[2 * (j - lead) + 1]);
        gpu_buffer_write(&along->tables[i], 0, along->texels,
                         (int64_t)(2 * n * sizeof *along->texels));
    }
}

void along_bind(const Along *along, uint32_t batch)
{
    if (along->hair) gpu_buffer_bind_texture(&along->tables[batch], BIND_ALONG);
}
