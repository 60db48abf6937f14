// SPDX-License-Identifier: MIT
#include "sim/follow.h"
#include "base/parallel.h"

#include "glsl/sim/follow_params.h"

#include <stdlib.h>
#include <string.h>

// The number of guides whose followers fit a buffer.
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

// Uploads the batch's followers. Copies of the last follower fill up the tile.
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

// The data of a follower that is bound to the mesh.
struct FollowerRoot {
    uint32_t strand[3]; // strands (of the file) that are its guides
    double weight[3];
    double place[3]; // position of its root at rest, m
};

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

// Copies each follower's guides (as strands of the file), weights and offset.
static struct FollowerRoot *copy_roots(const HairBatch *hair, const Follower *follower,
                                       const uint32_t *strand)
{
    struct FollowerRoot *roots = calloc(hair->strand_count + (size_t)1, sizeof *roots);
    for (uint32_t i = 0; roots && i < hair->strand_count; ++i)
        for (int k = 0; k < 3; ++k) {
            roots[i].strand[k] = strand[follower[i].guide[k]];
            roots[i].weight[k] = (double)follower[i].weight[k];
            roots[i].place[k] = (double)follower[i].offset[k];
        }
    return roots;
}

// Creates the followers of one batch of guides, split into as many batches as needed.
static Result create_batches(Follow *follow, uint32_t guide_batch, const FollowPlan *plan,
                             const GpuLimits *limits, Error *error)
{
    const HairBatch *guides = &follow->guides->batches[guide_batch];
    uint32_t n = guides->vertex_count, most = guides_that_fit(follow, n, limits);
    if (most == 0)
        return error_set(
            error, RESULT_FAILED,
            "%u followers of %u vertices exceed the limit of this driver's buffers: expected fewer",
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
    const ShaderDefine defines[] = {
        {"INTERPOLATE", options->interpolate}, {"CLUMPS", follow->clump > 0}, {0}};
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
                       .options = options,
                       .tip_separation = params->tip_separation,
                       .clump = params->clump};
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
        mesh_binding_destroy(&follow->batches[i].roots);
        free(follow->batches[i].root);
        free(follow->batches[i].offset);
    }
    free(follow->batches);
    free(follow->guide_rest);
    hair_destroy(&follow->hair);
    step_pass_destroy(&follow->pass);
    *follow = (Follow){0};
}

static Result bind_batch(Follow *follow, uint32_t i, BoundBody *body, const Strands *strands,
                         Error *error)
{
    const HairBatch *hair = &follow->hair.batches[i];
    FollowBatch *batch = &follow->batches[i];
    size_t slots = hair_slots(hair);
    float(*places)[3] = calloc(slots + 1, sizeof *places);
    batch->offset = gpu_buffer_read(&batch->offsets);
    Result result = places && batch->offset
                        ? RESULT_OK
                        : error_set(error, RESULT_FAILED, "no memory for %zu followers", slots);
    for (uint32_t s = 0; s < hair->strand_count && result == RESULT_OK; ++s) {
        struct FollowerRoot *root = &batch->root[s]; // `place` is still the offset from the guides
        for (int k = 0; k < 3; ++k) {
            for (int g = 0; g < 3; ++g)
                root->place[k] +=
                    root->weight[g] * (double)strands->position[strands->first[root->strand[g]]][k];
            places[s][k] = (float)root->place[k];
        }
    }
    THEN(result, bound_points_create(&batch->roots, body, (const float(*)[3])places,
                                     hair->strand_count, error));
    free(places);
    return result;
}

// Computes the plan a second time instead of keeping it: followers that are not bound then take no
// memory for it.
static Result find_roots(Follow *follow, uint32_t guide_batch, const Strands *strands, Error *error)
{
    const HairBatch *guides = &follow->guides->batches[guide_batch];
    FollowPlan plan;
    Result result = follow_plan_create(&plan, strands, guides->strand, guides->strand_count,
                                       &follow->options, error);
    for (uint32_t i = 0; i < follow->hair.batch_count && result == RESULT_OK; ++i) {
        FollowBatch *batch = &follow->batches[i];
        if (batch->guide_batch != guide_batch) continue;
        batch->root = copy_roots(
            &follow->hair.batches[i],
            &plan.follower[(size_t)batch->first_guide * follow->options.per_guide], guides->strand);
        if (!batch->root) result = error_set(error, RESULT_FAILED, "no memory for followers");
    }
    follow_plan_destroy(&plan);
    return result;
}

Result follow_bind(Follow *follow, BoundBody *body, const MeshBinding *roots,
                   const Strands *strands, Error *error)
{
    for (uint32_t i = 0; follow->hair.batch_count && i < follow->guides->batch_count; ++i)
        TRY(find_roots(follow, i, strands, error));
    for (uint32_t i = 0; i < follow->hair.batch_count; ++i)
        TRY(bind_batch(follow, i, body, strands, error));
    follow->guide_rest = malloc(((size_t)roots->count + 1) * sizeof *follow->guide_rest);
    if (!follow->guide_rest) return error_set(error, RESULT_FAILED, "no memory for followers");
    for (uint32_t s = 0; s < roots->count; ++s)
        for (int k = 0; k < 3; ++k)
            follow->guide_rest[s][k] = (double)strands->position[strands->first[s]][k];
    follow->guide_roots = roots;
    follow->shape = bound_body_shape(body, 0);
    return RESULT_OK;
}

typedef struct Moving {
    FollowBatch *batch;
    const HairBatch *hair;
    const BodyPose *pose;
    const double (*guide)[3]; // [strands] current positions of the guides' roots
    int parts;
} Moving;

// Sets each offset so that the follower's root stays on its place of the mesh.
static void move_part(void *data, int part)
{
    const Moving *moving = data;
    const BodyPose *pose = moving->pose;
    uint64_t count = hair_slots(moving->hair);
    uint32_t first = (uint32_t)(count * (uint64_t)part / (uint64_t)moving->parts),
             end = (uint32_t)(count * ((uint64_t)part + 1) / (uint64_t)moving->parts);
    for (uint32_t slot = first; slot < end; ++slot) {
        uint32_t s = slot < moving->hair->strand_count ? slot : moving->hair->strand_count - 1;
        const struct FollowerRoot *root = &moving->batch->root[s];
        double place[3];
        RigidMotion motion =
            mesh_binding_motion(&moving->batch->roots, s, (const float(*)[3])pose->position,
                                (const double(*)[4])pose->turn);
        rigid_motion_apply(&motion, root->place, place);
        for (int g = 0; g < 3; ++g)
            for (int k = 0; k < 3; ++k)
                place[k] -= root->weight[g] * moving->guide[root->strand[g]][k];
        for (int k = 0; k < 3; ++k) moving->batch->offset[slot][k] = (float)place[k];
    }
}

// The current positions of the guides' roots, [guide_roots->count], which the caller frees. NULL if
// memory is short.
static double (*place_guides(const Follow *follow, const BodyPose *pose))[3]
{
    double(*places)[3] = malloc(((size_t)follow->guide_roots->count + 1) * sizeof *places);
    for (uint32_t s = 0; places && s < follow->guide_roots->count; ++s) {
        RigidMotion motion =
            mesh_binding_motion(follow->guide_roots, s, (const float(*)[3])pose->position,
                                (const double(*)[4])pose->turn);
        rigid_motion_apply(&motion, follow->guide_rest[s], places[s]);
    }
    return places;
}

void follow_move(Follow *follow, BoundBody *body, double time)
{
    if (!follow->guide_roots || !follow->hair.batch_count) return;
    double shape = bound_body_shape(body, time);
    if (shape == follow->shape) return;
    const BodyPose *pose = bound_body_pose(body, time);
    double(*guide)[3] = place_guides(follow, pose);
    if (!guide) return;
    follow->shape = shape;
    for (uint32_t i = 0; i < follow->hair.batch_count; ++i) {
        Moving moving = {.batch = &follow->batches[i],
                         .hair = &follow->hair.batches[i],
                         .pose = pose,
                         .guide = (const double(*)[3])guide,
                         .parts = parallel_threads()};
        parallel_run(moving.parts, move_part, &moving);
        gpu_buffer_write(&moving.batch->offsets, 0, moving.batch->offset,
                         moving.batch->offsets.size);
    }
    free(guide);
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
                           .clump = follow->clump,
                           .per_guide = follow->per_guide};
    memcpy(params.head_rotation, head->rotation, sizeof head->rotation);
    gpu_timer_begin(follow->timer, "follow");
    for (uint32_t i = 0; i < follow->hair.batch_count; ++i) write_batch(follow, i, &params);
    glMemoryBarrier(GL_TEXTURE_FETCH_BARRIER_BIT | GL_SHADER_STORAGE_BARRIER_BIT);
    gpu_timer_end(follow->timer);
}
