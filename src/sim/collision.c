// SPDX-License-Identifier: MIT
#include "sim/collision.h"

#include <cglm/cglm.h>

#include <math.h>
#include <stdlib.h>
#include <string.h>

// A collider in the layout of the shader's buffer.
typedef struct Shape {
    float texel[COLLIDER_TEXELS][4];
} Shape;

// CPU drivers silently end all loops of an invocation after this many iterations.
enum { MOST_ITERATIONS_ON_CPU = 65535 };

// Rounds of Newton's method (collide.comp), and the fewest that are of use.
enum { MOST_ROUNDS = 12, FEWEST_ROUNDS = 2 };

// Strands of a lane on a CPU driver: their scratch memory then stays in the cache.
enum { MOST_STRANDS_ON_CPU = 8 };

// Cones up to this number are kept in registers: the shader is compiled for their count.
enum { MOST_IN_REGISTERS = 8 };

static int count_kind(const Colliders *colliders, ColliderKind kind)
{
    int count = 0;
    for (uint32_t i = 0; i < colliders->count; ++i) count += colliders->list[i].kind == kind;
    return count;
}

void collision_destroy(Collision *collision)
{
    for (uint32_t i = 0; collision->clearances && i < collision->hair->batch_count; ++i)
        gpu_buffer_destroy(&collision->clearances[i]);
    free(collision->clearances);
    for (uint32_t i = 0; collision->batches && i < collision->hair->batch_count; ++i) {
        gpu_buffer_destroy(&collision->batches[i].contacts);
        gpu_buffer_destroy(&collision->batches[i].forces);
        gpu_buffer_destroy(&collision->batches[i].scratch);
        gpu_buffer_destroy(&collision->batches[i].counts);
    }
    free(collision->batches);
    step_pass_destroy(&collision->pass);
    gpu_buffer_destroy(&collision->shapes);
    *collision = (Collision){0};
}

// Turns of all loops for a strand of n vertices: three sweeps and the push test each particle
// against every shape, a round tests it once more in one of its two sweeps.
static uint64_t iterations(const Collision *collision, uint64_t n, uint64_t rounds)
{
    uint64_t shapes = collision->colliders->count + (uint64_t)(collision->field != NULL);
    bool solves = collision->mode == COLLISION_PARTICLES;
    uint64_t pushes = shapes * (2 + CONTACT_PUSH_ROUNDS) + 2,
             sweeps = solves ? rounds * (shapes + 2) + CONTACT_VELOCITY_ROUNDS * 2 + 3 : 0;
    return n * (pushes + sweeps);
}

static uint32_t rounds_of(const Collision *collision, uint32_t n)
{
    uint32_t rounds = MOST_ROUNDS;
    while (collision->software && rounds > FEWEST_ROUNDS &&
           iterations(collision, n, rounds) > MOST_ITERATIONS_ON_CPU)
        --rounds;
    return rounds;
}

// Also decides how many strands a lane steps.
static Result check_loops(Collision *collision, Error *error)
{
    uint32_t strands = collision->software ? MOST_STRANDS_ON_CPU : 1;
    for (uint32_t i = 0; i < collision->hair->batch_count && collision->software; ++i) {
        uint32_t n = collision->hair->batches[i].vertex_count;
        if (iterations(collision, n, FEWEST_ROUNDS) > MOST_ITERATIONS_ON_CPU)
            return error_set(error, RESULT_USAGE,
                             "colliders: %u for strands of %u vertices: expected fewer (more "
                             "exceed the loop limit of a CPU driver)",
                             collision->colliders->count, n);
        uint64_t fit = MOST_ITERATIONS_ON_CPU / iterations(collision, n, MOST_ROUNDS);
        if (fit < strands) strands = fit ? (uint32_t)fit : 1;
    }
    collision->strands_per_lane = strands;
    return RESULT_OK;
}

static Result create_batches(Collision *collision, const GpuLimits *limits, Error *error)
{
    const Hair *hair = collision->hair;
    collision->batches = calloc((size_t)hair->batch_count + 1, sizeof *collision->batches);
    if (!collision->batches) return error_set(error, RESULT_FAILED, "no memory for collisions");
    for (uint32_t i = 0; i < hair->batch_count; ++i) {
        CollisionBatch *batch = &collision->batches[i];
        int64_t slots = hair_slots(&hair->batches[i]);
        TRY(gpu_buffer_create(&batch->contacts, limits, "contacts",
                              slots * hair->batches[i].vertex_count * 16, NULL, GL_RGBA32F, error));
        TRY(gpu_buffer_create(&batch->counts, limits, "counts of contacts", 16 * slots, NULL, 0,
                              error));
        gpu_buffer_clear(&batch->contacts, 0);
        gpu_buffer_clear(&batch->counts, 0);
        if (collision->mode != COLLISION_PARTICLES) continue;
        TRY(gpu_buffer_create(&batch->forces, limits, "forces of contacts",
                              slots * hair->batches[i].vertex_count * 16, NULL, GL_RGBA32F, error));
        uint64_t lanes = (uint64_t)limits->sizes.strands,
                 per_group = lanes * collision->strands_per_lane,
                 groups = (hair->batches[i].strand_count + per_group - 1) / per_group,
                 tiles = (groups * lanes + STRAND_TILE - 1) / STRAND_TILE;
        TRY(gpu_buffer_create(
            &batch->scratch, limits, "scratch memory of contacts",
            (int64_t)(tiles * STRAND_TILE * hair->batches[i].vertex_count *
                      (collision->bend ? CONTACT_BENDING_PLACES : CONTACT_PLACES) * 16),
            NULL, GL_RGBA32F, error));
        gpu_buffer_clear(&batch->forces, 0);
    }
    return RESULT_OK;
}

// Creates the shader pass for a mode.
static Result create_pass(Collision *collision, const Gpu *gpu, CollisionMode mode, Error *error)
{
    int cones = 0;
    const Colliders *colliders = collision->colliders;
#define ADD_CONE(kind, name, numbers, frame) cones += count_kind(colliders, COLLIDER_##kind);
    COLLIDERS(ADD_CONE, COLLIDER_NONE)
#define HAS(kind, name, numbers, frame) {"HAS_" #kind, count_kind(colliders, COLLIDER_##kind) > 0},
    const ShaderDefine defines[] = {
        {"MODE", (int)mode},
        {"CLEARANCE", mode != COLLISION_FINDING && collision->clearances},
        {"CONES", cones <= MOST_IN_REGISTERS ? cones : 0},
        {"FIELD", collision->field != NULL},
        {"BOUND", collision->frames != NULL},
        {"STRANDS", (int)collision->strands_per_lane},
        {"BENDS", collision->bend != NULL},
        {"MIDPOINT", collision->midpoint},
        COLLIDERS(COLLIDER_NONE, HAS){0}};
    return step_pass_create(&collision->pass, gpu, "sim/collide.comp", defines, error);
}

// Measures how far the groom's particles are from the colliders at time 0; closer contact than that
// does not push them.
static Result find_clearances(Collision *collision, const SolverSetup *setup, Error *error)
{
    static const HeadPose origin = {.rotation = {0, 0, 0, 1}};
    enum { LARGEST = 0x7f7fffff }; // largest float, as bits
    const Hair *hair = collision->hair;
    const HeadPose *head = setup->head ? setup->head : &origin;
    const SolverStep step = {.dt = 1, .head_old = *head, .head = *head};
    if (!setup->keeps_groom || collision->mode == COLLISION_SEGMENTS) return RESULT_OK;
    TRY(create_pass(collision, setup->gpu, COLLISION_FINDING, error));
    collision->clearances = calloc(hair->batch_count + (size_t)1, sizeof *collision->clearances);
    if (!collision->clearances)
        return error_set(error, RESULT_FAILED, "no memory for clearances of colliders");
    bool reached = collision_begin(collision, &step, 1, 1);
    for (uint32_t i = 0; i < hair->batch_count; ++i) {
        GpuBuffer *buffer = &collision->clearances[i];
        int64_t slots = hair_slots(&hair->batches[i]);
        TRY(gpu_buffer_create(buffer, &setup->gpu->limits, "clearances",
                              slots * hair->batches[i].vertex_count * (int64_t)sizeof(float), NULL,
                              GL_R32F, error));
        gpu_buffer_bind_storage(buffer, BIND_CLEARANCE_OUT);
        if (reached)
            collision_push(collision, i, NULL, NULL);
        else
            gpu_buffer_clear(buffer, LARGEST);
    }
    step_pass_destroy(&collision->pass);
    return RESULT_OK;
}

Result collision_create(Collision *collision, const SolverSetup *setup, CollisionMode mode,
                        const SolverRecipe *recipe, Error *error)
{
    *collision = (Collision){0};
    static const Colliders none;
    const Colliders *colliders = setup->colliders ? setup->colliders : &none;
    if ((!colliders->count && !setup->field) || !setup->params->collide) return RESULT_OK;
    *collision = (Collision){
        .hair = setup->hair,
        .bounds = setup->bounds ? setup->bounds : setup->hair,
        .params = setup->params,
        .colliders = colliders,
        .field = setup->field,
        .frames = setup->frames,
        .mode = mode,
        .carried = !recipe                      ? 1
                   : setup->params->clamped > 1 ? 2
                                                : recipe->carried,
        .bend = recipe && mode == COLLISION_PARTICLES && section_is_elastic(setup->params) &&
                        setup->params->youngs_modulus > 0
                    ? recipe->bend
                    : NULL,
        .midpoint = recipe && recipe->midpoint,
        .software = setup->gpu->software,
    };
    Result result = check_loops(collision, error);
    THEN(result,
         gpu_buffer_create(&collision->shapes, &setup->gpu->limits, "colliders",
                           (int64_t)(colliders->count * sizeof(Shape)), NULL, GL_RGBA32F, error));
    THEN(result, find_clearances(collision, setup, error));
    THEN(result, create_pass(collision, setup->gpu, mode, error));
    if (mode != COLLISION_DRAWN)
        THEN(result, create_batches(collision, &setup->gpu->limits, error));
    if (result != RESULT_OK) collision_destroy(collision);
    return result;
}

// A ball around the head that contains all hair, whatever the solver does to it.
static float hair_ball(const Hair *hair, const HeadPose *head, vec3 centre)
{
    vec3 middle, size;
    glm_vec3_center((float *)hair->low, (float *)hair->high, middle);
    glm_vec3_sub((float *)hair->high, (float *)hair->low, size);
    glm_quat_rotatev((float *)head->rotation, middle, centre);
    glm_vec3_add(centre, (float *)head->translation, centre);
    return 0.5f * glm_vec3_norm(size) + 2 * hair->longest;
}

// Distance that the shader computes to a cone that the hair cannot reach.
static const float NEVER = 1e30f;

// Writes the shapes by groups, and within a group those that move with the head first. The number
// of cones is compiled into the shader, so cones out of reach stay, but at distance NEVER; other
// shapes out of reach are left out. Returns how many shapes the hair can reach.
static uint32_t place_shapes(const Collision *collision, const HeadPose *head,
                             CollideParams *params, Shape *shapes)
{
    static const HeadPose world = {.rotation = {0, 0, 0, 1}};
    const Colliders *colliders = collision->colliders;
    uint32_t reached = 0, at = 0;
    vec3 centre = {0};
    float radius = hair_ball(collision->bounds, head, centre) + collision->params->collision_margin;
    for (uint32_t group = 0; group < COLLIDER_GROUPS; ++group) {
        params->shapes[group][0] = at;
        for (int fixed = 0; fixed < 2; ++fixed) {
            for (uint32_t i = 0; i < colliders->count; ++i) {
                const Collider *collider = &colliders->list[i];
                const HeadPose *frame = fixed ? &world : head;
                if (colliders_group(collider->kind) != group || collider->world != fixed) continue;
                colliders_pack(collider, frame->rotation, frame->translation, shapes[at].texel);
                bool reaches =
                    colliders_reach(collider, (const float(*)[4])shapes[at].texel, centre, radius);
                reached += reaches;
                if (!reaches && group == 0) shapes[at] = (Shape){.texel = {{0, 0, 0, -NEVER}}};
                at += reaches || group == 0;
            }
            params->shapes[group][1 + fixed] = at;
        }
    }
    return reached;
}

static CollideParams step_params(const Collision *collision, const SolverStep *step)
{
    CollideParams params = {
        .dt = (float)step->dt,
        .margin = collision->params->collision_margin,
        .friction = collision->params->friction,
        .longest = collision->bounds->longest,
        .bend = collision->bend ? collision->bend(collision->params, step->dt) : 0,
    };
    if (collision->field) {
        memcpy(params.field_low, collision->field->low, sizeof collision->field->low);
        params.field_low[3] = collision->field->spacing;
        for (int k = 0; k < 3; ++k) params.field_size[k] = (float)collision->field->size[k];
    }
    versor inverse;
    glm_quat_conjugate((float *)step->head.rotation, inverse);
    glm_quat_mul((float *)step->head_old.rotation, inverse, params.head_turn_back);
    head_put(params.head_rotation, params.head_translation, &step->head);
    memcpy(params.head_translation_old, step->head_old.translation,
           sizeof step->head_old.translation);
    return params;
}

// The number that marks this sub-step's contacts. It depends only on the step, so that a resumed
// run has the same numbers; the last sub-step counts as part 0. It is exact as a float and above 0,
// the value in fresh buffers.
static float stamp_of(uint32_t step, int part, int parts)
{
    enum { STEPS = 1 << 13, PARTS = 1 << 10 };
    return (float)(1 + step % STEPS * PARTS + (uint32_t)(part % parts % PARTS));
}

bool collision_begin(Collision *collision, const SolverStep *step, int part, int parts)
{
    if (!collision->pass.program) return false;
    Shape *shapes = calloc(collision->colliders->count + (size_t)1, sizeof *shapes);
    if (!shapes) return false;
    CollideParams params = step_params(collision, step);
    bool any = place_shapes(collision, &step->head, &params, shapes) > 0 || collision->field;
    if (any) {
        gpu_buffer_write(&collision->shapes, 0, shapes,
                         (int64_t)(collision->colliders->count * sizeof *shapes));
        collision->step = params;
    }
    collision->step.part = 1 / (float)parts;
    collision->step.stamp = stamp_of(step->number, part, parts);
    collision->step.stamp_before = part > 1 ? stamp_of(step->number, part - 1, parts)
                                            : stamp_of(step->number - 1, parts, parts);
    free(shapes);
    return any;
}

void collision_push(Collision *collision, uint32_t batch, const GpuBuffer *state,
                    const GpuBuffer *tips)
{
    const HairBatch *hair = &collision->hair->batches[batch];
    collision->step.strand_count = hair->strand_count;
    collision->step.vertex_count = hair->vertex_count;
    collision->step.carried = hair->held > collision->carried ? hair->held : collision->carried;
    collision->step.rounds = rounds_of(collision, hair->vertex_count);
    if (hair->rest.texture) gpu_buffer_bind_texture(&hair->rest, BIND_REST);
    gpu_buffer_bind_texture(&hair->position, BIND_POSITION);
    gpu_buffer_bind_storage(&hair->position, BIND_POSITION_OUT);
    gpu_buffer_bind_texture(&collision->shapes, BIND_COLLIDERS);
    if (collision->field) gpu_buffer_bind_texture(&collision->field->values, BIND_FIELD);
    if (collision->clearances)
        gpu_buffer_bind_texture(&collision->clearances[batch], BIND_CLEARANCE);
    if (state) {
        gpu_buffer_bind_texture(state, BIND_STATE);
        gpu_buffer_bind_storage(state, BIND_STATE_OUT);
    }
    if (tips) gpu_buffer_bind_storage(tips, BIND_TIPS);
    if (collision->frames && collision->mode == COLLISION_SEGMENTS)
        gpu_buffer_bind_texture(&collision->frames[batch], BIND_FRAMES);
    if (collision->batches) {
        gpu_buffer_bind_texture(&collision->batches[batch].contacts, BIND_CONTACTS_BEFORE);
        gpu_buffer_bind_storage(&collision->batches[batch].contacts, BIND_CONTACTS);
        gpu_buffer_bind_storage(&collision->batches[batch].counts, BIND_CONTACT_COUNTS);
    }
    if (collision->batches && collision->mode == COLLISION_PARTICLES) {
        gpu_buffer_bind_texture(&collision->batches[batch].forces, BIND_CONTACT_FORCES_BEFORE);
        gpu_buffer_bind_storage(&collision->batches[batch].forces, BIND_CONTACT_FORCES);
        gpu_buffer_bind_texture(&collision->batches[batch].scratch, BIND_SCRATCH_BEFORE);
        gpu_buffer_bind_storage(&collision->batches[batch].scratch, BIND_SCRATCH);
    }
    step_pass_run(&collision->pass, &collision->step, sizeof collision->step,
                  (hair->strand_count + collision->strands_per_lane - 1) /
                      collision->strands_per_lane);
    glMemoryBarrier(GL_TEXTURE_FETCH_BARRIER_BIT | GL_SHADER_STORAGE_BARRIER_BIT);
}

void collision_push_drawn(Collision *collision, const HeadPose *head)
{
    const SolverStep step = {.dt = 1, .head_old = *head, .head = *head};
    if (!collision_begin(collision, &step, 1, 1)) return;
    for (uint32_t i = 0; i < collision->hair->batch_count; ++i)
        collision_push(collision, i, NULL, NULL);
}

const CollisionBatch *collision_memory(const Collision *collision, uint32_t batch)
{
    return collision->batches ? &collision->batches[batch] : NULL;
}

static float float_of_bits(uint32_t bits)
{
    float value;
    memcpy(&value, &bits, sizeof value);
    return value;
}

void collision_report(const Collision *collision, SolverReport *report)
{
    for (uint32_t i = 0; collision->batches && i < collision->hair->batch_count; ++i) {
        uint32_t strands = collision->hair->batches[i].strand_count;
        uint32_t(*counts)[4] = gpu_buffer_read(&collision->batches[i].counts);
        if (!counts) return;
        for (uint32_t s = 0; s < strands; ++s) {
            if (counts[s][1] == (uint32_t)collision->step.stamp) report->contacts += counts[s][0];
            report->deepest_found = fmaxf(report->deepest_found, float_of_bits(counts[s][2]));
            report->deepest_left = fmaxf(report->deepest_left, float_of_bits(counts[s][3]));
        }
        free(counts);
    }
}
