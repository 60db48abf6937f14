// SPDX-License-Identifier: MIT
#include "bench_trial.h"

#include <stdlib.h>

Result trial_create(Trial *trial, const Gpu *gpu, const Strands *strands,
                    const SectionParams *params, double rate, Error *error)
{
    *trial = (Trial){.params = *params,
                     .step = {.dt = 1 / rate, .first = true, .gravity = {0, -9.81f, 0}}};
    trial->step.head.rotation[3] = trial->step.head_old.rotation[3] = 1;
    gpu_timer_create(&trial->timer, false, true);
    Result result = hair_create(&trial->hair, strands, 0, &gpu->limits, error);
    if (result != RESULT_OK) return result;
    trial->points = calloc(trial->hair.particle_count, sizeof *trial->points);
    if (!trial->points) return error_set(error, RESULT_FAILED, "no memory for positions");
    const SolverSetup setup = {
        .gpu = gpu, .timer = &trial->timer, .hair = &trial->hair, .params = &trial->params};
    return solver_create(&trial->solver, &setup, error);
}

void trial_destroy(Trial *trial)
{
    solver_destroy(&trial->solver);
    hair_destroy(&trial->hair);
    gpu_timer_destroy(&trial->timer);
    free(trial->points);
    *trial = (Trial){0};
}

void trial_step(Trial *trial)
{
    solver_step(&trial->solver, &trial->step);
    trial->step.head_old = trial->step.head;
    trial->step.first = false;
    ++trial->step.shuffle;
    ++trial->steps;
}

Result trial_read(Trial *trial, Error *error)
{
    solver_pose(&trial->solver, &trial->step.head);
    return hair_read_positions(&trial->hair, trial->points, error);
}

Result trial_make_strand(Strands *strands, const double (*points)[3], int n, Error *error)
{
    Result result = strands_create(strands, 1, (uint32_t)n, error);
    if (result != RESULT_OK) return result;
    strands->first[1] = (uint32_t)n;
    for (int i = 0; i < 3 * n; ++i) strands->position[i / 3][i % 3] = (float)points[i / 3][i % 3];
    return RESULT_OK;
}
