// SPDX-License-Identifier: MIT
#include "sim/bound.h"
#include "base/parallel.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

typedef float Float4[4];

// --- The body.

void bound_body_destroy(BoundBody *bound)
{
    for (int i = 0; i < BODY_POSES; ++i) {
        free(bound->poses[i].position);
        free(bound->poses[i].turn);
    }
    free(bound->wanted);
    mesh_turns_destroy(&bound->turns);
    *bound = (BoundBody){0};
}

static Result make_poses(BoundBody *bound, Error *error)
{
    size_t vertices = bound->body->mesh->vertex_count;
    bound->wanted = calloc(vertices + 1, sizeof *bound->wanted);
    bool good = bound->wanted;
    for (int i = 0; i < BODY_POSES; ++i) {
        BodyPose *pose = &bound->poses[i];
        pose->position = calloc(vertices + 1, sizeof *pose->position);
        pose->turn = calloc(vertices + 1, sizeof *pose->turn);
        good = good && pose->position && pose->turn;
    }
    return good ? RESULT_OK
                : error_set(error, RESULT_FAILED, "no memory for a mesh of %zu vertices", vertices);
}

Result bound_body_create(BoundBody *bound, const Body *body, Error *error)
{
    *bound = (BoundBody){.body = body};
    if (!body) return RESULT_OK;
    Result result = mesh_turns_create(&bound->turns, body->mesh, error);
    THEN(result, make_poses(bound, error));
    if (result != RESULT_OK) bound_body_destroy(bound);
    return result;
}

double bound_body_shape(const BoundBody *bound, double time)
{
    return bound->body ? mesh_sequence_shape(&bound->body->sequence, time) : 0;
}

typedef struct Turning {
    const BoundBody *bound;
    BodyPose *pose;
    int parts;
} Turning;

static void find_turns(void *data, int part)
{
    const Turning *turning = data;
    uint64_t count = turning->bound->turns.vertex_count;
    uint32_t first = (uint32_t)(count * (uint64_t)part / (uint64_t)turning->parts),
             end = (uint32_t)(count * ((uint64_t)part + 1) / (uint64_t)turning->parts);
    for (uint32_t v = first; v < end; ++v)
        if (turning->bound->wanted[v])
            mesh_turns_find(&turning->bound->turns, v, (const float(*)[3])turning->pose->position,
                            turning->pose->turn[v]);
}

const BodyPose *bound_body_pose(BoundBody *bound, double time)
{
    double shape = bound_body_shape(bound, time);
    BodyPose *pose = &bound->poses[0]; // the least recently used pose
    ++bound->calls;
    for (int i = 0; i < BODY_POSES; ++i) {
        BodyPose *known = &bound->poses[i];
        if (known->used < pose->used) pose = known;
        if (!known->known || known->shape != shape) continue;
        known->used = bound->calls;
        return known;
    }
    pose->used = bound->calls;
    mesh_sequence_evaluate(&bound->body->sequence, time, pose->position);
    Turning turning = {bound, pose, parallel_threads()};
    parallel_run(turning.parts, find_turns, &turning);
    pose->shape = shape;
    pose->known = true;
    return pose;
}

// Marks the vertices whose turns are needed. Cached poses lack the turns of these vertices, so they
// are dropped.
static void want(BoundBody *bound, const MeshBinding *binding)
{
    for (uint32_t i = 0; i < binding->count; ++i)
        for (int c = 0; c < 3; ++c) bound->wanted[binding->points[i].corner[c]] = true;
    for (int i = 0; i < BODY_POSES; ++i) bound->poses[i].known = false;
}

// --- The strands.

void bound_destroy(Bound *bound)
{
    for (uint32_t i = 0; bound->frames && i < bound->hair->batch_count; ++i)
        gpu_buffer_destroy(&bound->frames[i]);
    free(bound->frames);
    free(bound->texels);
    *bound = (Bound){0};
}

enum { MOST_TEXELS = 6 }; // per strand

static Result make_buffers(Bound *bound, const GpuLimits *limits, Error *error)
{
    size_t all = 0;
    bound->frames = calloc((size_t)bound->hair->batch_count + 1, sizeof *bound->frames);
    if (!bound->frames) return error_set(error, RESULT_FAILED, "no memory for bound strands");
    for (uint32_t i = 0; i < bound->hair->batch_count; ++i) {
        size_t texels = MOST_TEXELS * (size_t)hair_slots(&bound->hair->batches[i]);
        TRY(gpu_buffer_create(&bound->frames[i], limits, "frames of bound strands",
                              (int64_t)(texels * sizeof(Float4)), NULL, GL_RGBA32F, error));
        all += texels;
    }
    bound->texels = malloc(all * sizeof *bound->texels + 1);
    return bound->texels ? RESULT_OK
                         : error_set(error, RESULT_FAILED, "no memory for bound strands");
}

Result bound_create(Bound *bound, BoundBody *body, uint32_t section, const Hair *hair,
                    const GpuLimits *limits, Error *error)
{
    *bound = (Bound){0};
    if (!body->body) return RESULT_OK;
    *bound = (Bound){.body = body, .roots = &body->body->roots[section], .hair = hair};
    want(body, bound->roots);
    Result result = make_buffers(bound, limits, error);
    if (result != RESULT_OK) bound_destroy(bound);
    return result;
}

static void put_motion(Float4 texels[2], const RigidMotion *motion, const RigidMotion *beside)
{
    double dot = 0;
    for (int k = 0; k < 4; ++k) dot += motion->rotation[k] * beside->rotation[k];
    for (int k = 0; k < 4; ++k)
        texels[0][k] = (float)(dot < 0 ? -motion->rotation[k] : motion->rotation[k]);
    for (int k = 0; k < 3; ++k) texels[1][k] = (float)motion->translation[k];
    texels[1][3] = 0;
}

// Fills the texels of one strand. `motions` are the motions of its root at the requested times.
typedef void FillStrand(Float4 *texels, const RigidMotion *motions, const void *data);

typedef struct Filling {
    Bound *bound;
    const HairBatch *batch;
    const BodyPose *poses[3];
    int times, texels, parts;
    bool goes_on; // the motion at the step's start is that of the last step's end
    Float4 *content;
    FillStrand *fill;
    const void *data;
} Filling;

static void fill_part(void *data, int part)
{
    const Filling *filling = data;
    const HairBatch *batch = filling->batch;
    uint64_t count = hair_slots(batch);
    uint32_t first = (uint32_t)(count * (uint64_t)part / (uint64_t)filling->parts),
             end = (uint32_t)(count * ((uint64_t)part + 1) / (uint64_t)filling->parts);
    for (uint32_t slot = first; slot < end; ++slot) {
        uint32_t s = slot < batch->strand_count ? slot : batch->strand_count - 1;
        RigidMotion motions[3];
        Float4 *own = filling->content + (size_t)slot * (size_t)filling->texels;
        if (filling->goes_on) {
            memcpy(own[0], own[2], 2 * sizeof *own);
            for (int k = 0; k < 4; ++k) motions[0].rotation[k] = (double)own[0][k];
        }
        for (int i = filling->goes_on; i < filling->times; ++i)
            motions[i] = mesh_binding_motion(filling->bound->roots, batch->strand[s],
                                             (const float(*)[3])filling->poses[i]->position,
                                             (const double(*)[4])filling->poses[i]->turn);
        if (filling->goes_on)
            put_motion(&own[2], &motions[1], &motions[0]);
        else
            filling->fill(own, motions, filling->data);
    }
}

static void fill(Bound *bound, const double *time, int times, int texels, FillStrand *fill_strand,
                 const void *data, bool goes_on)
{
    Float4 *content = bound->texels;
    Filling filling = {.bound = bound,
                       .times = times,
                       .texels = texels,
                       .parts = parallel_threads(),
                       .goes_on = goes_on,
                       .fill = fill_strand,
                       .data = data};
    for (int i = goes_on; i < times; ++i) filling.poses[i] = bound_body_pose(bound->body, time[i]);
    for (uint32_t i = 0; i < bound->hair->batch_count; ++i) {
        filling.batch = &bound->hair->batches[i];
        filling.content = content;
        parallel_run(filling.parts, fill_part, &filling);
        gpu_buffer_write(&bound->frames[i], 0, content,
                         (int64_t)((size_t)texels * hair_slots(filling.batch) * sizeof(Float4)));
        content += MOST_TEXELS * (size_t)hair_slots(filling.batch);
    }
}

static void fill_frames(Float4 *texels, const RigidMotion *motions, const void *data)
{
    int times = *(const int *)data;
    for (int i = 0; i < times; ++i) put_motion(&texels[2 * i], &motions[i], &motions[0]);
}

static void set(Bound *bound, BoundContent content, const double *time, int times)
{
    bool same = bound->content == content;
    if (!bound->body) return;
    bool goes_on = same && times == 2 && bound->shapes[1] == bound_body_shape(bound->body, time[0]);
    for (int i = 0; i < times; ++i) {
        double shape = bound_body_shape(bound->body, time[i]);
        same = same && bound->shapes[i] == shape;
        bound->shapes[i] = shape;
    }
    if (same) return;
    fill(bound, time, times, 2 * times, fill_frames, &times, goes_on);
    bound->content = content;
}

void bound_set(Bound *bound, double before, double after)
{
    set(bound, BOUND_FRAMES, (const double[]){before, after}, 2);
}

void bound_set_after(Bound *bound, double after)
{
    if (!bound->body) return;
    bool there =
        bound->content == BOUND_FRAMES && bound->shapes[1] == bound_body_shape(bound->body, after);
    if (!there) bound_set(bound, after, after);
}

void bound_set_between(Bound *bound, double earlier, double later, double now)
{
    set(bound, BOUND_BETWEEN, (const double[]){earlier, later, now}, 3);
}

static RigidMotion motion_of(const HeadPose *head)
{
    RigidMotion motion;
    for (int k = 0; k < 4; ++k) motion.rotation[k] = (double)head->rotation[k];
    for (int k = 0; k < 3; ++k) motion.translation[k] = (double)head->translation[k];
    return motion;
}

// --- Motions for carry.comp: rotation, translation, velocity, spin.

static void fill_way(Float4 *texels, const RigidMotion *motions, const void *data)
{
    const RigidMotion *head = data;
    RigidMotion from = rigid_motion_product(&head[0], &motions[0]),
                to = rigid_motion_product(&head[1], &motions[1]),
                back = rigid_motion_inverse(&from), way = rigid_motion_product(&to, &back);
    put_motion(texels, &way, &way);
    memset(texels[2], 0, 2 * sizeof *texels);
}

void bound_set_way(Bound *bound, double from_time, const HeadPose *from, double to_time,
                   const HeadPose *to)
{
    const RigidMotion head[2] = {motion_of(from), motion_of(to)};
    fill(bound, (const double[]){from_time, to_time}, 2, 4, fill_way, head, false);
    bound->content = BOUND_MOTIONS;
}

// Step of the one-sided second-order differences, as in head_starts_moving.
static const double START_H = 1e-3;

static void rotation_vector(const RigidMotion *from, const RigidMotion *to, Double3 vector)
{
    RigidMotion back = rigid_motion_inverse(from), way = rigid_motion_product(to, &back);
    const double *q = way.rotation;
    double sign = q[3] < 0 ? -1 : 1, sine = sqrt(double3_dot(q, q)),
           angle = 2 * atan2(sine, sign * q[3]);
    for (int k = 0; k < 3; ++k) vector[k] = sine > 0 ? sign * q[k] / sine * angle : 0;
}

static void fill_start(Float4 *texels, const RigidMotion *motions, const void *data)
{
    const RigidMotion *head = data, still = {.rotation = {0, 0, 0, 1}};
    RigidMotion at[3];
    Double3 near, far, spin, moved;
    for (int i = 0; i < 3; ++i) at[i] = rigid_motion_product(&head[i], &motions[i]);
    rotation_vector(&at[0], &at[1], near);
    rotation_vector(&at[0], &at[2], far);
    put_motion(texels, &still, &still);
    for (int k = 0; k < 3; ++k) spin[k] = (4 * near[k] - far[k]) / (2 * START_H);
    double3_cross(spin, at[0].translation, moved);
    for (int k = 0; k < 3; ++k) {
        double velocity = (4 * (at[1].translation[k] - at[0].translation[k]) -
                           (at[2].translation[k] - at[0].translation[k])) /
                          (2 * START_H);
        texels[2][k] = (float)(velocity - moved[k]); // velocity of the body's point at the origin
        texels[3][k] = (float)spin[k];
    }
    texels[2][3] = texels[3][3] = 0;
}

void bound_set_start(Bound *bound, const RigidTrack *track)
{
    double time[3];
    RigidMotion head[3];
    for (int i = 0; i < 3; ++i) {
        HeadPose pose = head_at(track, time[i] = i * START_H);
        head[i] = motion_of(&pose);
    }
    fill(bound, time, 3, 4, fill_start, head, false);
    bound->content = BOUND_MOTIONS;
}

Result bound_points_create(MeshBinding *binding, BoundBody *body, const float (*points)[3],
                           uint32_t count, Error *error)
{
    TRY(mesh_binding_create(binding, body->body->mesh, body->body->name, points, count, error));
    want(body, binding);
    return RESULT_OK;
}
