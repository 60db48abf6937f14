// SPDX-License-Identifier: MIT
#include "sim/solver.h"

#include "glsl/sim/tressfx_params.h"

#include <math.h>
#include <string.h>

// llvmpipe silently ends all loops of an invocation after this many iterations.
enum { MOST_ITERATIONS_ON_CPU = 65535 };

// Newton steps of `steady` towards the rest lengths; the rebuilding of the strand corrects what is
// left.
enum { STEADY_LENGTH_PASSES = 2 };

static bool is_faithful(const SectionParams *params)
{
    return strcmp(params->variant, "tressfx4") == 0;
}

// The stiffness that a share k of 0 .. 1 stands for, as --style multiplies it.
static float firmness(float share)
{
    return share / (1 - 0.75f * share);
}

// The share that makes a pass `times` as stiff, at most `most`.
static float share_times(float share, float times, float most)
{
    float firm = firmness(share) * times;
    return fminf(firm / (1 + 0.75f * firm), most);
}

static void fill(void *block, StepParams *uniforms, const SolverStep *step,
                 const SectionParams *params)
{
    bool faithful = is_faithful(params);
    double rate = (double)params->drag +
                  (double)params->tressfx_damping * (double)params->tressfx_damping_rate;
    bool half = step->first && !faithful;
    step_drag_factors(rate, half ? step->dt / 2 : step->dt, &uniforms->decay, &uniforms->gain);
    // TressFX's parameters are per frame of 1/60 s.
    float frames = (float)(step->dt * (double)params->tressfx_damping_rate);
    float per_frame = faithful ? 1 : frames, per_frame2 = per_frame * per_frame;
    float odds = step_style_odds(params), most = params->tressfx_local_max;
    float local = share_times(fminf(params->tressfx_local_constraint_stiffness, most), odds, most);
    float global = params->tressfx_global_constraint_stiffness;
    float spring = global / fmaxf(1 - global, 1e-6f) * odds * per_frame2;
    int passes = params->tressfx_local_constraints_iterations;
    float longer = fmaxf(per_frame, 1);
    *(TressfxParams *)block = (TressfxParams){
        .local_share = params->tressfx_local_share * local,
        .local_times = 2 / (float)(passes > 0 ? passes : 1) * per_frame2,
        .local_most = params->tressfx_local_share * most,
        .global_share = spring / (1 + spring),
        .global_range = params->tressfx_global_constraints_range,
        .shock = params->tressfx_vsp_coeff,
        .shock_threshold = 0.01f * params->tressfx_vsp_accel_threshold * per_frame2,
        .most_move = 0.01f * params->tressfx_clamp_position_delta * per_frame,
        // Steps longer than a frame already damp more, and long strands whip if the share is too
        // large: 64 vertices without drag at 30 Hz whip with 0.15 and more, but not with 0.01 to
        // 0.1. This gives 1/16 there.
        .exchanged = 1 / (longer * longer * longer),
        .local_passes = passes,
        .length_passes = params->tressfx_length_constraints_iterations,
    };
}

static void along(float texel[4], const void *block, const void *mean, const SectionParams *there)
{
    const TressfxParams *tressfx = block;
    (void)mean, (void)there;
    texel[0] = tressfx->local_share, texel[1] = tressfx->global_share;
}

static void define(ShaderDefine *defines, const SectionParams *params)
{
    defines[0] = (ShaderDefine){"TRESSFX4", is_faithful(params)};
}

// The number of loops over a strand: predicting, writing, local passes and length passes.
static int64_t count_loops(const SectionParams *params)
{
    int64_t lengths = is_faithful(params)
                          ? (params->tressfx_length_constraints_iterations + 1) / 2 + 1
                          : 2 * STEADY_LENGTH_PASSES;
    return 2 + params->tressfx_local_constraints_iterations + lengths;
}

static Result check_loops(const SolverSetup *setup, Error *error)
{
    int64_t passes = count_loops(setup->params);
    for (uint32_t i = 0; i < setup->hair->batch_count && setup->gpu->software; ++i) {
        uint32_t n = setup->hair->batches[i].vertex_count;
        if (n * passes > MOST_ITERATIONS_ON_CPU)
            return error_set(error, RESULT_USAGE,
                             "tressfx: a strand of %u vertices: expected at most %lld with these "
                             "iterations (longer strands exceed the loop limit of a CPU driver)",
                             n, (long long)(MOST_ITERATIONS_ON_CPU / passes));
    }
    return RESULT_OK;
}

static const SolverRecipe RECIPE = {
    .label = "sim_tressfx",
    .shader = "sim/tressfx.comp",
    .carried = 2,
    .check = check_loops,
    .params_size = sizeof(TressfxParams),
    .fill = fill,
    .define = define,
    .along = along,
};

const SolverType SOLVER_TRESSFX = {
    .name = "tressfx",
    .summary = "AMD's TressFX: constraints pull vertices and bends to the style; fast moves of the "
               "head carry whole strands along",
    .lengths = "exact; variant tressfx4: strands stretch",
    .style = "local and global shape, --style, and the options --tressfx-*",
    .variants = {"steady", "tressfx4"},
    .published = "tressfx4",
    .recipes = {&RECIPE},
};
