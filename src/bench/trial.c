// SPDX-License-Identifier: MIT
#include "bench/trial.h"

#include <math.h>
#include <stdlib.h>

Result trial_create(Trial *trial, const Gpu *gpu, const Strands *strands, uint32_t first_id,
                    const SectionParams *params, double rate, Error *error)
{
    *trial = (Trial){.params = *params,
                     .rate = rate,
                     .step = {.dt = 1 / rate, .first = true, .gravity = {0, -9.81f, 0}}};
    trial->step.head.rotation[3] = trial->step.head_old.rotation[3] = 1;
    gpu_timer_create(&trial->timer, false, true);
    TRY(hair_create(&trial->hair, strands, first_id, &gpu->limits, error));
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
    ++trial->step.number;
    ++trial->steps;
}

Result trial_read(Trial *trial, Error *error)
{
    solver_pose(&trial->solver, &trial->step.head);
    return hair_read_positions(&trial->hair, trial->points, error);
}

const GpuBuffer *trial_buffer(const Trial *trial, uint32_t batch, SolverBufferKind kind)
{
    SolverBuffer buffers[SOLVER_MAX_BUFFERS];
    int count = solver_buffers(&trial->solver, batch, buffers);
    for (int i = 0; i < count; ++i)
        if (buffers[i].kind == kind) return buffers[i].buffer;
    return NULL;
}

bool trial_read_tip(const Trial *trial, uint32_t batch, uint32_t strand, float tip[2][4])
{
    const GpuBuffer *tips = trial_buffer(trial, batch, SOLVER_TIPS);
    if (!tips) return false;
    glBindBuffer(GL_SHADER_STORAGE_BUFFER, tips->buffer);
    glGetBufferSubData(GL_SHADER_STORAGE_BUFFER, (GLintptr)(strand * sizeof(float[2][4])),
                       sizeof(float[2][4]), tip);
    return true;
}

Result trial_make_strands(Strands *strands, const double (*points)[3], uint32_t count, int n,
                          Error *error)
{
    uint32_t total = count * (uint32_t)n;
    TRY(strands_create(strands, count, total, error));
    for (uint32_t s = 0; s <= count; ++s) strands->first[s] = s * (uint32_t)n;
    for (uint32_t i = 0; i < 3 * total; ++i)
        strands->position[i / 3][i % 3] = (float)points[i / 3][i % 3];
    return RESULT_OK;
}

void trial_make_beam(double (*points)[3], int n, double length)
{
    for (int j = 0; j < n; ++j)
        points[j][0] = length * j / (n - 1), points[j][1] = points[j][2] = 0;
}

// Segments of equal length: a circle of `turns` turns across the axis, and what is left of the
// length along it.
void trial_make_helix(double (*points)[3], int n, double length, double turns)
{
    const double radius = 0.02, along[3] = {0.6, -0.8, 0}, up[3] = {0.8, 0.6, 0};
    double angle = 6.283185307179586 * turns / (n - 1), l = length / (n - 1);
    double chord = 2 * radius * sin(angle / 2), rise = sqrt(fmax(l * l - chord * chord, 0));
    for (int j = 0; j < n; ++j) {
        double x = rise * j, y = radius * (cos(angle * j) - 1), z = radius * sin(angle * j);
        for (int k = 0; k < 3; ++k) points[j][k] = x * along[k] + y * up[k] + (k == 2 ? z : 0);
    }
}
