// SPDX-License-Identifier: MIT
#include "sim/collision.h"

#include <cglm/cglm.h>

#include <math.h>
#include <stdlib.h>
#include <string.h>

// What a shader reads of a shape. Cones: first point and radius there; unit axis and length L;
// g = growth of the radius a metre, g/sqrt(1 - g^2). Planes: unit normal and height; 0; 0.
typedef struct Shape {
    float texel[COLLIDER_TEXELS][4];
} Shape;

// CPU drivers end loops silently after so many iterations in all of an invocation.
enum { MOST_ITERATIONS_ON_CPU = 65535, ROUNDS = 3 };

// So many cones a shader is compiled for.
enum { MOST_IN_REGISTERS = 8 };

// What a scene has: cones that move with the head, all cones, planes.
typedef struct ShapeCounts {
    uint32_t moved, cones, planes;
} ShapeCounts;

static bool is_flat(const Collider *collider)
{
    return collider->kind == COLLIDER_PLANE || collider->kind == COLLIDER_GROUND;
}

static ShapeCounts count_shapes(const Colliders *colliders)
{
    ShapeCounts counts = {0};
    for (uint32_t i = 0; i < colliders->count; ++i) {
        bool flat = is_flat(&colliders->list[i]);
        counts.planes += flat;
        counts.cones += !flat;
        counts.moved += !flat && !colliders->list[i].world;
    }
    return counts;
}

void collision_destroy(Collision *collision)
{
    for (uint32_t i = 0; collision->batches && i < collision->hair->batch_count; ++i) {
        gpu_buffer_destroy(&collision->batches[i].contacts);
        gpu_buffer_destroy(&collision->batches[i].counts);
    }
    free(collision->batches);
    if (collision->program) glDeleteProgram(collision->program);
    gpu_buffer_destroy(&collision->uniforms);
    gpu_buffer_destroy(&collision->shapes);
    *collision = (Collision){0};
}

// Each particle is tested against every shape, and in contact again in each round.
static Result check_loops(const Collision *collision, bool software, Error *error)
{
    for (uint32_t i = 0; i < collision->hair->batch_count && software; ++i) {
        uint64_t n = collision->hair->batches[i].vertex_count;
        uint64_t most = MOST_ITERATIONS_ON_CPU / n / (ROUNDS + 3);
        if (collision->colliders->count + (collision->field != NULL) > most)
            return error_set(error, RESULT_USAGE,
                             "%u colliders: strands of %u vertices take at most %llu of them on "
                             "this CPU driver",
                             collision->colliders->count, collision->hair->batches[i].vertex_count,
                             (unsigned long long)most);
    }
    return RESULT_OK;
}

static Result create_batch(CollisionBatch *batch, const HairBatch *hair, const GpuLimits *limits,
                           Error *error)
{
    uint32_t slots = hair_slots(hair);
    size_t particles = (size_t)hair->vertex_count * slots;
    float *zero = calloc(particles, 4 * sizeof *zero);
    if (!zero) return error_set(error, RESULT_FAILED, "no memory for %zu particles", particles);
    Result result =
        gpu_buffer_create(&batch->contacts, limits, "contacts",
                          (int64_t)(particles * 4 * sizeof *zero), zero, GL_RGBA32F, error);
    if (result == RESULT_OK)
        result = gpu_buffer_create(&batch->counts, limits, "counts of contacts",
                                   16 * (int64_t)slots, zero, 0, error);
    free(zero);
    return result;
}

static Result create_batches(Collision *collision, const GpuLimits *limits, Error *error)
{
    const Hair *hair = collision->hair;
    collision->batches = calloc((size_t)hair->batch_count + 1, sizeof *collision->batches);
    if (!collision->batches) return error_set(error, RESULT_FAILED, "no memory for collisions");
    Result result = RESULT_OK;
    for (uint32_t i = 0; i < hair->batch_count && result == RESULT_OK; ++i)
        result = create_batch(&collision->batches[i], &hair->batches[i], limits, error);
    return result;
}

Result collision_create(Collision *collision, const SolverSetup *setup, CollisionMode mode,
                        uint32_t carried, Error *error)
{
    *collision = (Collision){0};
    static const Colliders none;
    const Colliders *colliders = setup->colliders ? setup->colliders : &none;
    if ((!colliders->count && !setup->field) || !setup->params->collide) return RESULT_OK;
    *collision = (Collision){
        .hair = setup->hair,
        .bounds = setup->hair,
        .params = setup->params,
        .colliders = colliders,
        .field = setup->field,
        .mode = mode,
        .carried = carried,
        .group_size = step_group_size(setup->gpu),
    };
    const ShapeCounts counts = count_shapes(colliders);
    const ShaderDefine defines[] = {
        {"GROUP_SIZE", (int)collision->group_size},
        {"MODE", (int)mode},
        {"CONES", counts.cones <= MOST_IN_REGISTERS ? (int)counts.cones : 0},
        {"FIELD", setup->field != NULL},
        {0}};
    Result result = check_loops(collision, setup->gpu->software, error);
    if (result == RESULT_OK)
        result = shader_build_compute(&collision->program, "sim/collide.comp", defines, error);
    if (result == RESULT_OK)
        result =
            gpu_buffer_create(&collision->shapes, &setup->gpu->limits, "colliders",
                              (int64_t)(colliders->count * sizeof(Shape)), NULL, GL_RGBA32F, error);
    if (result == RESULT_OK && mode != COLLISION_DRAWN)
        result = create_batches(collision, &setup->gpu->limits, error);
    if (result != RESULT_OK) collision_destroy(collision);
    return result;
}

static void place(const HeadPose *frame, const float at[3], vec3 placed)
{
    glm_quat_rotatev((float *)frame->rotation, (float *)at, placed);
    glm_vec3_add(placed, (float *)frame->translation, placed);
}

// A cone one of whose ends lies in the other is that other's sphere.
static void set_cone(Shape *shape, const Collider *collider, const HeadPose *frame)
{
    const float *a = collider->numbers;
    const float *b = collider->kind == COLLIDER_CAPSULE ? a + 4 : a;
    vec3 axis;
    glm_vec3_sub((float *)b, (float *)a, axis);
    float length = glm_vec3_norm(axis), more = b[3] - a[3];
    if (length <= fabsf(more)) {
        if (more > 0) a = b;
        length = 0;
    }
    *shape = (Shape){0};
    place(frame, a, shape->texel[0]);
    shape->texel[0][3] = a[3];
    if (!(length > 0)) return;
    glm_vec3_scale(axis, 1 / length, axis);
    glm_quat_rotatev((float *)frame->rotation, axis, shape->texel[1]);
    shape->texel[1][3] = length;
    double grow = (double)more / (double)length;
    shape->texel[2][0] = (float)grow;
    shape->texel[2][1] = (float)(grow / sqrt(1 - grow * grow));
}

static void set_plane(Shape *shape, const Collider *collider)
{
    const float *numbers = collider->numbers, ground[4] = {0, 1, 0, numbers[0]};
    *shape = (Shape){0};
    memcpy(shape->texel[0], collider->kind == COLLIDER_GROUND ? ground : numbers,
           sizeof shape->texel[0]);
}

// A ball that all hair stays in, whatever the solver does to it.
static float hair_ball(const Hair *hair, const HeadPose *head, vec3 centre)
{
    vec3 middle, size;
    glm_vec3_center((float *)hair->low, (float *)hair->high, middle);
    glm_vec3_sub((float *)hair->high, (float *)hair->low, size);
    place(head, middle, centre);
    return 0.5f * glm_vec3_norm(size) + 2 * hair->longest;
}

static bool cone_reaches(const Shape *shape, const vec3 centre, float radius)
{
    vec3 middle;
    glm_vec3_copy((float *)shape->texel[0], middle);
    glm_vec3_muladds((float *)shape->texel[1], 0.5f * shape->texel[1][3], middle);
    float largest =
        fmaxf(shape->texel[0][3], shape->texel[0][3] + shape->texel[2][0] * shape->texel[1][3]);
    return glm_vec3_distance(middle, (float *)centre) <
           radius + largest + 0.5f * shape->texel[1][3];
}

static bool plane_reaches(const Shape *shape, const vec3 centre, float radius)
{
    return glm_vec3_dot((float *)shape->texel[0], (float *)centre) - shape->texel[0][3] < radius;
}

// Where the next shape of a kind goes: cones that move, other cones, planes.
static Shape *next_shape(Shape *shapes, const Collider *collider, const ShapeCounts *counts,
                         ShapeCounts *placed)
{
    if (is_flat(collider)) return &shapes[counts->cones + placed->planes++];
    if (collider->world) return &shapes[counts->moved + placed->cones++];
    return &shapes[placed->moved++];
}

// At what distance everything is from a shape that hair cannot reach.
static const float NEVER = 1e30f;

// Returns how many of them the hair can reach.
static uint32_t place_shapes(const Collision *collision, const HeadPose *head, Shape *shapes)
{
    static const HeadPose world = {.rotation = {0, 0, 0, 1}};
    const Colliders *colliders = collision->colliders;
    const ShapeCounts counts = count_shapes(colliders);
    ShapeCounts placed = {0};
    uint32_t reached = 0;
    vec3 centre = {0};
    float radius = hair_ball(collision->bounds, head, centre) + collision->params->collision_margin;
    for (uint32_t i = 0; i < colliders->count; ++i) {
        const Collider *collider = &colliders->list[i];
        Shape *shape = next_shape(shapes, collider, &counts, &placed);
        if (is_flat(collider))
            set_plane(shape, collider);
        else
            set_cone(shape, collider, collider->world ? &world : head);
        bool reaches = is_flat(collider) ? plane_reaches(shape, centre, radius)
                                         : cone_reaches(shape, centre, radius);
        reached += reaches;
        if (!reaches) *shape = (Shape){.texel = {{0, 0, 0, -NEVER}}};
    }
    return reached;
}

static CollideParams step_params(const Collision *collision, const SolverStep *step)
{
    const ShapeCounts counts = count_shapes(collision->colliders);
    CollideParams params = {
        .dt = (float)step->dt,
        .margin = collision->params->collision_margin,
        .friction = collision->params->friction,
        .longest = collision->bounds->longest,
        .carried = collision->carried,
        .cones = counts.cones,
        .cones_moved = counts.moved,
        .planes = counts.planes,
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

// A number for each sub-step that follows from the step alone, so that a run can be resumed: the
// last part of a step counts as part 0 of it. Exact as a float, above 0, which fresh buffers hold.
static float stamp_of(uint32_t step, int part, int parts)
{
    enum { STEPS = 1 << 13, PARTS = 1 << 10 };
    return (float)(1 + step % STEPS * PARTS + (uint32_t)(part % parts % PARTS));
}

bool collision_begin(Collision *collision, const SolverStep *step, int part, int parts)
{
    if (!collision->program) return false;
    Shape *shapes = malloc((collision->colliders->count + (size_t)1) * sizeof *shapes);
    if (!shapes) return false;
    bool any = place_shapes(collision, &step->head, shapes) > 0 || collision->field;
    if (any) {
        glBindBuffer(GL_SHADER_STORAGE_BUFFER, collision->shapes.buffer);
        glBufferSubData(GL_SHADER_STORAGE_BUFFER, 0,
                        (GLsizeiptr)(collision->colliders->count * sizeof *shapes), shapes);
        collision->step = step_params(collision, step);
    }
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
    gpu_buffer_set_uniforms(&collision->uniforms, BIND_STEP, &collision->step,
                            sizeof collision->step);
    if (hair->rest.texture) gpu_buffer_bind_texture(&hair->rest, BIND_REST);
    gpu_buffer_bind_texture(&hair->position, BIND_POSITION);
    gpu_buffer_bind_storage(&hair->position, BIND_POSITION_OUT);
    gpu_buffer_bind_texture(&collision->shapes, BIND_COLLIDERS);
    if (collision->field) gpu_buffer_bind_texture(&collision->field->values, BIND_FIELD);
    if (state) {
        gpu_buffer_bind_texture(state, BIND_STATE);
        gpu_buffer_bind_storage(state, BIND_STATE_OUT);
    }
    if (tips) gpu_buffer_bind_storage(tips, BIND_TIPS);
    if (collision->batches) {
        gpu_buffer_bind_texture(&collision->batches[batch].contacts, BIND_CONTACTS_BEFORE);
        gpu_buffer_bind_storage(&collision->batches[batch].contacts, BIND_CONTACTS);
        gpu_buffer_bind_storage(&collision->batches[batch].counts, BIND_CONTACT_COUNTS);
    }
    glUseProgram(collision->program);
    glDispatchCompute(step_group_count(hair->strand_count, collision->group_size, 1), 1, 1);
    glMemoryBarrier(GL_TEXTURE_FETCH_BARRIER_BIT | GL_SHADER_STORAGE_BARRIER_BIT);
}

void collision_push_drawn(Collision *collision, const HeadPose *head)
{
    const SolverStep step = {.dt = 1, .head_old = *head, .head = *head};
    if (!collision_begin(collision, &step, 1, 1)) return;
    for (uint32_t i = 0; i < collision->hair->batch_count; ++i)
        collision_push(collision, i, NULL, NULL);
}

const GpuBuffer *collision_memory(const Collision *collision, uint32_t batch)
{
    return collision->batches ? &collision->batches[batch].contacts : NULL;
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
        uint32_t(*counts)[4] = malloc(strands * sizeof *counts);
        if (!counts) return;
        glBindBuffer(GL_SHADER_STORAGE_BUFFER, collision->batches[i].counts.buffer);
        glGetBufferSubData(GL_SHADER_STORAGE_BUFFER, 0, (GLsizeiptr)(strands * sizeof *counts),
                           counts);
        for (uint32_t s = 0; s < strands; ++s) {
            if (counts[s][1] == (uint32_t)collision->step.stamp) report->contacts += counts[s][0];
            report->deepest_found = fmaxf(report->deepest_found, float_of_bits(counts[s][2]));
            report->deepest_left = fmaxf(report->deepest_left, float_of_bits(counts[s][3]));
        }
        free(counts);
    }
}
