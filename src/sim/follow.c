// SPDX-License-Identifier: MIT
#include "sim/follow.h"

#include "glsl/sim/follow_params.h"

#include <stdlib.h>
#include <string.h>

// How many guides' followers a buffer holds.
static uint32_t guides_that_fit(const Follow *follow, uint32_t vertex_count,
                                const GpuLimits *limits)
{
    int64_t texels = limits->storage_block / 16;
    if (limits->texture_texels < texels) texels = limits->texture_texels;
    int64_t strands = texels / vertex_count / STRAND_TILE * STRAND_TILE;
    return (uint32_t)(strands / follow->per_guide);
}

typedef float Float4[4];
typedef uint32_t Uint4[4];

// What the GPU is given of the batch's followers; the last one's copies fill the tile.
static Result upload_batch(HairBatch *hair, FollowBatch *batch, const Follower *follower,
                           const GpuLimits *limits, Error *error)
{
    size_t slots = hair_slots(hair);
    Float4 *offsets = malloc(slots * sizeof *offsets);
    Uint4 *guides = calloc(slots, sizeof *guides);
    uint32_t *ids = malloc(slots * sizeof *ids);
    Result result = RESULT_OK;
    if (!offsets || !guides || !ids)
        result = error_set(error, RESULT_FAILED, "no memory for %zu followers", slots);
    for (uint32_t slot = 0; slot < slots && result == RESULT_OK; ++slot) {
        const Follower *of = &follower[slot < hair->strand_count ? slot : hair->strand_count - 1];
        memcpy(guides[slot], &of->guide[1], 2 * sizeof of->guide[1]);
        memcpy(&guides[slot][2], &of->weight[2], sizeof of->weight[2]);
        memcpy(offsets[slot], of->offset, sizeof of->offset);
        offsets[slot][3] = of->weight[1];
        ids[slot] = of->id;
    }
    int64_t count = (int64_t)slots;
    THEN(result, gpu_buffer_create(&hair->position, limits, "followers' positions",
                                   count * hair->vertex_count * 16, NULL, GL_RGBA32F, error));
    THEN(result, gpu_buffer_create(&hair->strand_id, limits, "followers' numbers", count * 4, ids,
                                   GL_R32UI, error));
    THEN(result, gpu_buffer_create(&batch->offsets, limits, "followers' offsets", count * 16,
                                   offsets, GL_RGBA32F, error));
    THEN(result, gpu_buffer_create(&batch->guides, limits, "followers' guides", count * 16, guides,
                                   GL_RGBA32UI, error));
    free(offsets);
    free(guides);
    free(ids);
    return result;
}

static bool add_batch(Follow *follow)
{
    Hair *hair = &follow->hair;
    HairBatch *hairs = realloc(hair->batches, (hair->batch_count + 1) * sizeof *hairs);
    if (hairs) hair->batches = hairs;
    FollowBatch *batches = realloc(follow->batches, (hair->batch_count + 1) * sizeof *batches);
    if (batches) follow->batches = batches;
    if (!hairs || !batches) return false;
    hairs[hair->batch_count] = (HairBatch){0};
    batches[hair->batch_count++] = (FollowBatch){0};
    return true;
}

// The followers of one batch of guides, in as many batches as they need.
static Result create_batches(Follow *follow, uint32_t guide_batch, const FollowPlan *plan,
                             const GpuLimits *limits, Error *error)
{
    const HairBatch *guides = &follow->guides->batches[guide_batch];
    uint32_t n = guides->vertex_count, most = guides_that_fit(follow, n, limits);
    if (most == 0)
        return error_set(error, RESULT_FAILED,
                         "%u followers of %u vertices exceed this driver's buffers",
                         follow->per_guide, n);
    for (uint32_t first = 0; first < guides->strand_count; first += most) {
        uint32_t left = guides->strand_count - first, count = left < most ? left : most;
        if (!add_batch(follow)) return error_set(error, RESULT_FAILED, "no memory for followers");
        uint32_t last = follow->hair.batch_count - 1;
        HairBatch *hair = &follow->hair.batches[last];
        hair->vertex_count = n;
        hair->strand_count = count * follow->per_guide;
        hair->strand = malloc(hair->strand_count * sizeof *hair->strand);
        if (!hair->strand) return error_set(error, RESULT_FAILED, "no memory for followers");
        for (uint32_t i = 0; i < hair->strand_count; ++i)
            hair->strand[i] = guides->strand[first + i / follow->per_guide];
        follow->batches[last].guide_batch = guide_batch;
        follow->batches[last].first_guide = first;
        TRY(upload_batch(hair, &follow->batches[last],
                         &plan->follower[(size_t)first * follow->per_guide], limits, error));
    }
    return RESULT_OK;
}

static Result build(Follow *follow, const Gpu *gpu, const Strands *strands,
                    const FollowOptions *options, Error *error)
{
    const ShaderDefine defines[] = {{"INTERPOLATE", options->interpolate}, {0}};
    Result result = step_pass_create(&follow->pass, gpu, "sim/follow.comp", defines, error);
    for (uint32_t i = 0; i < follow->guides->batch_count && result == RESULT_OK; ++i) {
        const HairBatch *guides = &follow->guides->batches[i];
        FollowPlan plan;
        result = follow_plan_create(&plan, strands, guides->strand, guides->strand_count, options,
                                    error);
        THEN(result, create_batches(follow, i, &plan, &gpu->limits, error));
        follow_plan_destroy(&plan);
    }
    return result;
}

Result follow_create(Follow *follow, const Gpu *gpu, GpuTimer *timer, const Hair *guides,
                     const Strands *strands, const SectionParams *params, uint32_t seed,
                     Error *error)
{
    const FollowOptions options = follow_plan_options(params, strands, seed);
    *follow = (Follow){0};
    if (options.per_guide == 0 || guides->strand_count == 0) return RESULT_OK;
    if (guides->particle_count > UINT32_MAX / options.per_guide)
        return error_set(error, RESULT_USAGE,
                         "followers: %u for each of %u guides: expected fewer than 2^32 vertices",
                         options.per_guide, guides->strand_count);
    *follow = (Follow){.guides = guides,
                       .timer = timer,
                       .per_guide = options.per_guide,
                       .tip_separation = params->tip_separation};
    follow->hair.strand_count = options.per_guide * guides->strand_count;
    follow->hair.particle_count = options.per_guide * guides->particle_count;
    follow->hair.segment_count = options.per_guide * guides->segment_count;
    Result result = build(follow, gpu, strands, &options, error);
    if (result != RESULT_OK) follow_destroy(follow);
    return result;
}

void follow_destroy(Follow *follow)
{
    for (uint32_t i = 0; i < follow->hair.batch_count; ++i) {
        gpu_buffer_destroy(&follow->batches[i].offsets);
        gpu_buffer_destroy(&follow->batches[i].guides);
    }
    free(follow->batches);
    hair_destroy(&follow->hair);
    step_pass_destroy(&follow->pass);
    *follow = (Follow){0};
}

static void write_batch(Follow *follow, uint32_t i, FollowParams *params)
{
    const HairBatch *hair = &follow->hair.batches[i];
    const FollowBatch *batch = &follow->batches[i];
    params->strand_count = hair->strand_count;
    params->vertex_count = hair->vertex_count;
    params->first_guide = batch->first_guide;
    gpu_buffer_bind_texture(&follow->guides->batches[batch->guide_batch].position, BIND_POSITION);
    gpu_buffer_bind_texture(&batch->offsets, BIND_FOLLOW_OFFSETS);
    gpu_buffer_bind_texture(&batch->guides, BIND_FOLLOW_GUIDES);
    gpu_buffer_bind_storage(&hair->position, BIND_POSITION_OUT);
    step_pass_run(&follow->pass, params, sizeof *params, hair->strand_count);
}

void follow_write(Follow *follow, const HeadPose *head)
{
    if (!follow->hair.batch_count) return;
    FollowParams params = {.tip_separation = follow->tip_separation,
                           .per_guide = follow->per_guide};
    memcpy(params.head_rotation, head->rotation, sizeof head->rotation);
    gpu_timer_begin(follow->timer, "follow");
    for (uint32_t i = 0; i < follow->hair.batch_count; ++i) write_batch(follow, i, &params);
    glMemoryBarrier(GL_TEXTURE_FETCH_BARRIER_BIT | GL_SHADER_STORAGE_BARRIER_BIT);
    gpu_timer_end(follow->timer);
}
