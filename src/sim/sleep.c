// SPDX-License-Identifier: MIT
#include "sim/sleep.h"

#include "glsl/sim/sleep_params.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

// Constants of the rule in sleep.h.
static const double CHECKS_A_SECOND = 4, CALM_S = 2, REACH_S = 120;
enum { MOST_AGAIN = 64 };
static const float LEAVE = 1.0f / 4, GROW = 1.0f / 60;

static Result create_batch(SleepBatch *batch, const HairBatch *hair, const GpuLimits *limits,
                           Error *error)
{
    int64_t slots = hair_slots(hair);
    TRY(gpu_buffer_create(&batch->anchors, limits, "hair's anchors",
                          slots * hair->vertex_count * 16, NULL, 0, error));
    TRY(gpu_buffer_create(&batch->calm, limits, "hair's calm", slots * 4, NULL, 0, error));
    gpu_buffer_clear(&batch->anchors, 0);
    gpu_buffer_clear(&batch->calm, 0);
    return RESULT_OK;
}

Result sleep_create(Sleep *sleep, const Gpu *gpu, GpuTimer *timer, const Hair *hair,
                    const Solver *solver, const SectionParams *params, Error *error)
{
    *sleep = (Sleep){0};
    if (params->sleep == 0 || solver_is_static(solver->type)) return RESULT_OK;
    *sleep = (Sleep){.hair = hair,
                     .timer = timer,
                     .tolerance = params->sleep,
                     .batches = calloc(hair->batch_count + 1, sizeof *sleep->batches)};
    Result result = step_pass_create(&sleep->pass, gpu, "sim/sleep.comp", NULL, error);
    if (!sleep->batches)
        result = error_set(error, RESULT_FAILED, "no memory for %u batches", hair->batch_count);
    for (uint32_t i = 0; i < hair->batch_count; ++i)
        THEN(result, create_batch(&sleep->batches[i], &hair->batches[i], &gpu->limits, error));
    if (result != RESULT_OK) sleep_destroy(sleep);
    return result;
}

void sleep_destroy(Sleep *sleep)
{
    for (uint32_t i = 0; sleep->batches && i < sleep->hair->batch_count; ++i) {
        gpu_buffer_destroy(&sleep->batches[i].anchors);
        gpu_buffer_destroy(&sleep->batches[i].calm);
    }
    free(sleep->batches);
    step_pass_destroy(&sleep->pass);
    *sleep = (Sleep){0};
}

// Whether everything that moves hair is the same in two steps and constant within them.
static bool same_forces(const SolverStep *a, const SolverStep *b)
{
    return a->dt == b->dt && !a->first && !b->first && head_is_same(&a->head, &b->head) &&
           head_is_same(&b->head_old, &b->head) && b->shape_old == b->shape &&
           a->shape == b->shape && a->params_stamp == b->params_stamp &&
           memcmp(a->gravity, b->gravity, sizeof a->gravity) == 0 &&
           memcmp(a->wind, b->wind, sizeof a->wind) == 0;
}

// Steps to the next check: 3/4 and 5/4 of the mean in turn.
static int interval(const Sleep *sleep)
{
    double mean = 1 / (CHECKS_A_SECOND * sleep->last.dt);
    return (int)fmax(1, mean * (sleep->checks % 2 ? 1.25 : 0.75));
}

bool sleep_skips(Sleep *sleep, const SolverStep *step)
{
    if (!sleep->hair) return false;
    bool same = same_forces(&sleep->last, step);
    sleep->last = *step;
    if (!same) {
        sleep->steps = sleep->checks = sleep->due = 0;
        sleep->asleep = false;
    }
    return sleep->asleep;
}

// Whether every strand was ready at the last check.
static bool all_ready(const Sleep *sleep)
{
    uint32_t all = SLEEP_READY;
    for (uint32_t i = 0; i < sleep->hair->batch_count; ++i) {
        uint32_t count = sleep->hair->batches[i].strand_count;
        uint32_t *calm = gpu_buffer_read(&sleep->batches[i].calm);
        if (!calm) return false;
        for (uint32_t s = 0; s < count; ++s) all &= calm[s];
        free(calm);
    }
    return all != 0;
}

static void check(Sleep *sleep)
{
    bool again = sleep->checks <= MOST_AGAIN && (sleep->checks & (sleep->checks - 1)) == 0;
    double checks_a_second = fmin(CHECKS_A_SECOND, 1 / sleep->last.dt);
    SleepParams params = {
        .leave = sleep->tolerance * LEAVE,
        .grow = sleep->tolerance * GROW,
        .checks = (float)fmax(2, CALM_S * checks_a_second),
        .checks_reach = (float)(REACH_S * checks_a_second / (double)sleep->tolerance),
    };
    params.anchor = sleep->checks == 0 ? SLEEP_ANCHOR_ALL
                    : again            ? SLEEP_ANCHOR_UNREADY
                                       : SLEEP_ANCHOR_LEFT;
    for (uint32_t i = 0; i < sleep->hair->batch_count; ++i) {
        const HairBatch *hair = &sleep->hair->batches[i];
        params.strand_count = hair->strand_count;
        params.vertex_count = hair->vertex_count;
        gpu_buffer_bind_texture(&hair->position, BIND_POSITION);
        gpu_buffer_bind_texture(&hair->rest, BIND_REST);
        gpu_buffer_bind_storage(&sleep->batches[i].anchors, BIND_ANCHORS_OUT);
        gpu_buffer_bind_storage(&sleep->batches[i].calm, BIND_CALM_OUT);
        step_pass_run(&sleep->pass, &params, sizeof params, hair->strand_count);
    }
    glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT);
}

void sleep_check(Sleep *sleep, const Solver *solver)
{
    if (!sleep->hair || ++sleep->steps < sleep->due) return;
    if (sleep->checks > 1 && all_ready(sleep)) {
        sleep->asleep = true;
        return;
    }
    solver_pose(solver, &sleep->last.head);
    gpu_timer_begin(sleep->timer, "sleep");
    check(sleep);
    gpu_timer_end(sleep->timer);
    sleep->due = sleep->steps + interval(sleep);
    ++sleep->checks;
}
