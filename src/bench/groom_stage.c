// SPDX-License-Identifier: MIT
#include "bench/groom_stage.h"
#include "base/clock.h"
#include "base/interrupt.h"
#include "bench/scene_words.h"
#include "scene/scalp_guess.h"
#include "strands/strands_edit.h"

#include <cglm/cglm.h>

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { FPS = 60, REST_FRAMES = 4 * FPS, JITTER_FRAMES = FPS / 2 };
enum { PERIOD_FRAMES = FPS, SHAKE_FRAMES = 3 * PERIOD_FRAMES, WARM_UP_FRAMES = 10 };
static const char YAW[] = "40*sin(2*pi*t)"; // degrees

// --- The stage.

static Result read_scene(GroomStage *stage, const GroomSetup *setup, Error *error)
{
    char rate[64];
    Scene *scene = &stage->scene;
    snprintf(rate, sizeof rate, "--fps %d --sim-rate %.9g", FPS, setup->rate);
    const char *const names[] = {setup->file, setup->mesh ? "--mesh" : NULL, setup->mesh, NULL};
    const char *const flags[SCENE_WORDS_FLAGS] = {"--quiet --sleep 0 -o groom/", rate, setup->flags,
                                                  ""};
    TRY(scene_words_read(scene, &stage->words, names, flags, error));
    if (scene->file)
        return error_set(error, RESULT_USAGE, "%s: is a scene file: expected a hair file",
                         scene->file);
    return trial_apply(&scene->sections[0].params, &setup->method, error);
}

static Result thin(Strands *strands, int most, Error *error)
{
    uint32_t count = (uint32_t)most;
    if (most == 0 || count >= strands->strand_count) return RESULT_OK;
    uint32_t *which = calloc(count, sizeof *which);
    if (!which) return error_set(error, RESULT_FAILED, "no memory for %u strands", count);
    for (uint64_t i = 0; i < count; ++i) which[i] = (uint32_t)(i * strands->strand_count / count);
    Result result = strands_pick(strands, which, count, error);
    free(which);
    return result;
}

static Result read_assets(GroomStage *stage, const GroomSetup *setup, Error *error)
{
    TRY(assets_load(&stage->assets, &stage->scene, NULL, false, error));
    TRY(scalp_guess(&stage->scene, &stage->assets, NULL, false, error));
    TRY(thin(&stage->assets.strands[0], setup->strands, error));
    head_middle(stage->middle, stage->assets.strands, stage->scene.section_count);
    return RESULT_OK;
}

static Result start_shaking(GroomStage *stage, Error *error)
{
    RigidTrack *head = &stage->scene.bodies[0].head;
    memcpy(head->pivot, stage->middle, sizeof head->pivot);
    for (uint32_t k = 0; k < 3; ++k)
        TRY(track_set_formula(&head->rotation, k, k == 1 ? YAW : "0", &RIGID_TRACK_DEGREES, error));
    return RESULT_OK;
}

static Result make_room(GroomStage *stage, Error *error)
{
    const Hair *hair = &stage->simulation.sections[0].hair;
    size_t points = hair->particle_count + 1, tips = hair->strand_count + (size_t)1;
    stage->points = calloc(points, sizeof *stage->points);
    stage->before = calloc(points, sizeof *stage->before);
    stage->low = calloc(tips, sizeof *stage->low);
    stage->high = calloc(tips, sizeof *stage->high);
    if (stage->points && stage->before && stage->low && stage->high) return RESULT_OK;
    return error_set(error, RESULT_FAILED, "no memory for %zu particles", points);
}

// Reads the drawn positions of all strands: guides, then followers.
static Result read_drawn(GroomStage *stage, Error *error)
{
    const SimulationSection *section = &stage->simulation.sections[0];
    TRY(hair_read_positions(&section->hair, stage->drawn, error));
    if (!section->follow.hair.batch_count) return RESULT_OK;
    return hair_read_positions(&section->follow.hair, &stage->drawn[section->hair.particle_count],
                               error);
}

static uint32_t list_strands(uint32_t *first, const Hair *hair, uint32_t at)
{
    for (uint32_t b = 0; b < hair->batch_count; ++b)
        for (uint32_t i = 0; i < hair->batches[b].strand_count; ++i, ++first) {
            *first = at;
            at += hair->batches[b].vertex_count;
        }
    *first = at;
    return at;
}

// Finds the neighbours of each drawn strand. The groom must be in its rest pose.
static Result find_locks(GroomStage *stage, Error *error)
{
    const Hair *guides = &stage->simulation.sections[0].hair,
               *followers = &stage->simulation.sections[0].follow.hair;
    uint64_t points = guides->particle_count + followers->particle_count;
    uint32_t strands = guides->strand_count + followers->strand_count;
    if (points > UINT32_MAX)
        return error_set(error, RESULT_USAGE,
                         "%llu vertices with followers: expected fewer than 2^32",
                         (unsigned long long)points);
    uint32_t *first = calloc((size_t)strands + 1, sizeof *first);
    stage->drawn = calloc(points + 1, sizeof *stage->drawn);
    Result result = RESULT_OK;
    if (!first || !stage->drawn)
        result = error_set(error, RESULT_FAILED, "no memory for %u strands", strands);
    THEN(result, read_drawn(stage, error));
    if (result == RESULT_OK) {
        uint32_t at = list_strands(first, guides, 0);
        list_strands(&first[guides->strand_count], followers, at);
        result = groom_locks_create(&stage->locks, (const float(*)[3])stage->drawn, first, strands,
                                    error);
    }
    free(first);
    return result;
}

Result groom_stage_create(GroomStage *stage, const Gpu *gpu, const GroomSetup *setup, Error *error)
{
    *stage = (GroomStage){0};
    gpu_timer_create(&stage->timer, false, gpu->software);
    TRY(read_scene(stage, setup, error));
    TRY(read_assets(stage, setup, error));
    if (setup->shaking) TRY(start_shaking(stage, error));
    const Mesh *mesh = stage->assets.meshes->vertex_count ? stage->assets.meshes : NULL;
    TRY(simulation_create(&stage->simulation, gpu, &stage->timer, &stage->scene,
                          stage->assets.strands, mesh, error));
    TRY(groom_shape_create(&stage->shape, &stage->simulation.sections[0].hair,
                           stage->assets.strands, mesh, error));
    simulation_pose(&stage->simulation);
    if (setup->locks) TRY(find_locks(stage, error));
    return make_room(stage, error);
}

void groom_stage_destroy(GroomStage *stage)
{
    groom_shape_destroy(&stage->shape);
    groom_locks_destroy(&stage->locks);
    if (stage->simulation.scene) simulation_destroy(&stage->simulation);
    gpu_timer_destroy(&stage->timer);
    assets_destroy(&stage->assets);
    scene_destroy(&stage->scene);
    free(stage->points);
    free(stage->before);
    free(stage->drawn);
    free(stage->low);
    free(stage->high);
    free(stage->words);
    *stage = (GroomStage){0};
}

// --- Frames.

// Copies the drawn positions, transformed to the head's frame.
static Result read_points(GroomStage *stage, Error *error)
{
    const Hair *hair = &stage->simulation.sections[0].hair;
    HeadPose head = stage->simulation.bodies[0].head;
    float(*last)[3] = stage->before;
    stage->before = stage->points, stage->points = last;
    TRY(hair_read_positions(hair, stage->points, error));
    versor back;
    glm_quat_conjugate(head.rotation, back);
    for (uint64_t v = 0; v < hair->particle_count; ++v) {
        vec3 from = {0};
        for (int k = 0; k < 3; ++k) from[k] = stage->points[v][k] - head.translation[k];
        glm_quat_rotatev(back, from, stage->points[v]);
    }
    return RESULT_OK;
}

static const float (*points_of(const GroomStage *stage))[3]
{
    return (const float(*)[3])stage->points;
}

// Simulates a frame. *ms: time for each step, NaN if the frame had no step.
static Result next_frame(GroomStage *stage, bool read, double *ms, Error *error)
{
    Simulation *simulation = &stage->simulation;
    if (interrupt_requested()) return error_set(error, RESULT_INTERRUPTED, "interrupted");
    uint64_t steps = simulation->steps;
    glFinish();
    double begin = clock_ms();
    simulation_advance(simulation);
    glFinish();
    *ms = (clock_ms() - begin) / (double)(simulation->steps - steps);
    simulation_pose(simulation);
    return read ? read_points(stage, error) : RESULT_OK;
}

// --- At rest.

Result groom_stage_rest(GroomStage *stage, GroomRest *rest, Error *error)
{
    double ms;
    *rest = (GroomRest){0};
    while (simulation_settle(&stage->simulation)) {
    }
    for (int frame = 1; frame <= REST_FRAMES; ++frame) {
        int first = REST_FRAMES - JITTER_FRAMES; // the first frame that is read
        TRY(next_frame(stage, frame >= first, &ms, error));
        if (frame > first)
            rest->jitter = groom_shape_greater(rest->jitter,
                                               groom_shape_step(&stage->shape, points_of(stage),
                                                                (const float(*)[3])stage->before));
    }
    groom_shape_displacement(&stage->shape, points_of(stage), &rest->mean, &rest->tips);
    TRY(groom_shape_voxels(&stage->shape, points_of(stage), &rest->voxels, error));
    rest->voxels /= stage->shape.voxels;
    return groom_shape_depth(&stage->shape, points_of(stage), &rest->deepest, &rest->beyond, error);
}

// --- In the shake.

static void take_tips(GroomStage *stage, bool first)
{
    for (uint32_t s = 0; s < stage->shape.strand_count; ++s) {
        const float *tip = stage->points[stage->shape.first[s + 1] - 1];
        for (int k = 0; k < 3; ++k) {
            stage->low[s][k] = first ? tip[k] : fminf(stage->low[s][k], tip[k]);
            stage->high[s][k] = first ? tip[k] : fmaxf(stage->high[s][k], tip[k]);
        }
    }
}

static double find_swing(const GroomStage *stage)
{
    double sum = 0;
    for (uint32_t s = 0; s < stage->shape.strand_count; ++s) {
        Double3 low, high;
        double3_from_float(stage->low[s], low);
        double3_from_float(stage->high[s], high);
        sum += double3_distance(low, high) / 2 / (double)stage->shape.length[s];
    }
    return sum / stage->shape.strand_count;
}

static Result measure_period(GroomStage *stage, GroomShake *shake, bool first, Error *error)
{
    double deepest, beyond;
    take_tips(stage, first);
    TRY(groom_shape_depth(&stage->shape, points_of(stage), &deepest, &beyond, error));
    shake->deepest = first ? deepest : fmax(shake->deepest, deepest);
    shake->beyond = first ? beyond : fmax(shake->beyond, beyond);
    if (!stage->drawn) return RESULT_OK;
    TRY(read_drawn(stage, error));
    double together = groom_locks_kept(&stage->locks, (const float(*)[3])stage->drawn);
    shake->together = first ? together : fmin(shake->together, together);
    return RESULT_OK;
}

Result groom_stage_shake(GroomStage *stage, GroomShake *shake, Error *error)
{
    double samples[SHAKE_FRAMES], ms;
    int count = 0, last = SHAKE_FRAMES - PERIOD_FRAMES;
    const GroomShape *shape = &stage->shape;
    *shake = (GroomShake){0};
    while (simulation_settle(&stage->simulation)) {
    }
    for (int frame = 1; frame <= SHAKE_FRAMES; ++frame) {
        TRY(next_frame(stage, true, &ms, error));
        double spread = groom_shape_spread(shape, points_of(stage), stage->middle);
        shake->flare = groom_shape_greater(shake->flare, spread);
        if (frame > WARM_UP_FRAMES && frame <= last && isfinite(ms)) samples[count++] = ms;
        if (frame > last) TRY(measure_period(stage, shake, frame == last + 1, error));
    }
    shake->flare /= groom_shape_spread(shape, (const float(*)[3])shape->point, stage->middle);
    shake->swing = find_swing(stage);
    shake->step = table_times(samples, count);
    return RESULT_OK;
}
