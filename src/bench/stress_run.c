// SPDX-License-Identifier: MIT
#include "bench/stress_run.h"
#include "base/interrupt.h"
#include "bench/stress_bound.h"
#include "gpu/shader.h"
#include "scene/forces.h"
#include "sim/solver.h"
#include "sim/step.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define PI 3.14159265358979323846

enum { JUMP_PERIOD = 64 };

const char *const STRESS_RULE_NAMES[STRESS_RULES] = {"finite", "lengths", "energy", "rest"};

typedef struct Run {
    const StressCase *set;
    int steps;
    double allowed;
    Hair hair;
    SectionParams params;
    Scene scene; // its wind
    GpuTimer timer;
    Solver solver;
    SolverStep step;
    StressBound bound;
    GLuint program;
    uint32_t group_size;
    GpuBuffer before, worst, first, uniforms;
} Run;

bool stress_verdict_fails(const StressVerdict *verdict)
{
    for (int i = 0; i < STRESS_RULES; ++i)
        if (verdict->first[i]) return true;
    return false;
}

static void run_destroy(Run *run)
{
    solver_destroy(&run->solver);
    hair_destroy(&run->hair);
    params_destroy_section(&run->params);
    gpu_timer_destroy(&run->timer);
    if (run->program) glDeleteProgram(run->program);
    gpu_buffer_destroy(&run->before);
    gpu_buffer_destroy(&run->worst);
    gpu_buffer_destroy(&run->first);
    gpu_buffer_destroy(&run->uniforms);
}

static Result upload(Run *run, const Gpu *gpu, const StressCase *strands, int count, Error *error)
{
    uint32_t n = (uint32_t)run->set->value[STRESS_n];
    Strands made;
    Result result = strands_create(&made, (uint32_t)count, (uint32_t)count * n, error);
    if (result != RESULT_OK) return result;
    for (uint32_t s = 0; s < (uint32_t)count; ++s) {
        made.first[s + 1] = (s + 1) * n;
        stress_case_make_strand(&strands[s], &made.position[s * n]);
    }
    result = hair_create(&run->hair, &made, (uint32_t)run->set->value[STRESS_strand], &gpu->limits,
                         error);
    strands_destroy(&made);
    return result;
}

static Result create_check(Run *run, const Gpu *gpu, Error *error)
{
    const HairBatch *batch = &run->hair.batches[0];
    run->group_size = step_group_size(gpu);
    const ShaderDefine defines[] = {
        {"GROUP_SIZE", (int)run->group_size}, {"TIP", stress_bound_tip_only(run->set)}, {0}};
    int64_t size = (int64_t)hair_slots(batch) * 16;
    void *zero = calloc((size_t)size, 1);
    if (!zero) return error_set(error, RESULT_FAILED, "no memory for verdicts");
    Result result = shader_build_compute(&run->program, "bench/stress.comp", defines, error);
    if (result == RESULT_OK)
        result = gpu_buffer_create(&run->before, &gpu->limits, "positions before a step",
                                   batch->position.size, NULL, GL_RGBA32F, error);
    if (result == RESULT_OK)
        result = gpu_buffer_create(&run->worst, &gpu->limits, "verdicts", size, zero, 0, error);
    if (result == RESULT_OK)
        result = gpu_buffer_create(&run->first, &gpu->limits, "verdicts", size, zero, 0, error);
    free(zero);
    return result;
}

// The head after step i: off the origin, to and fro along x, shaken along z, turning about z; it
// stands still in the second half.
static HeadPose pose_at(const Run *run, int i)
{
    const double *value = run->set->value;
    int moving = i < run->steps / 2 ? i : run->steps / 2;
    double time = moving * value[STRESS_dt], half = fmod(value[STRESS_spin] * time, 4 * PI) / 2;
    double jumped = moving / JUMP_PERIOD % 2 ? value[STRESS_jump] : 0;
    double shaken = value[STRESS_shake] * sin(2 * PI * value[STRESS_shake_rate] * time);
    return (HeadPose){{0, 0, (float)sin(half), (float)cos(half)},
                      {(float)(value[STRESS_away] + jumped), 0, (float)shaken}};
}

static bool is_looked_at(const Run *run, int i)
{
    bool jumps = run->set->value[STRESS_jump] > 0 && i <= run->steps / 2 + 8;
    return i <= 64 || i % 16 == 0 || i == run->steps || (jumps && i % JUMP_PERIOD < 8);
}

// The root, which lies at (0, arm, 0) in the head's frame, as float32 has it in the world.
static void root_at(const Run *run, const HeadPose *pose, double root[3])
{
    double s = (double)pose->rotation[2], c = (double)pose->rotation[3],
           arm = run->set->value[STRESS_arm];
    root[0] = (double)(float)((double)pose->translation[0] - 2 * s * c * arm);
    root[1] = (double)(float)((double)pose->translation[1] + (c * c - s * s) * arm);
    root[2] = (double)pose->translation[2];
}

static Result run_create(Run *run, const Gpu *gpu, const StressCase *strands, int count, int steps,
                         double allowed, Error *error)
{
    *run = (Run){.set = strands, .steps = steps, .allowed = allowed};
    const double *value = strands->value;
    double pitch = value[STRESS_wind_pitch] * PI / 180;
    RunParams *forces = &run->scene.run;
    forces->gravity[1] = (float)-value[STRESS_gravity];
    forces->wind[0] = (float)(value[STRESS_wind] * sin(pitch));
    forces->wind[1] = (float)(value[STRESS_wind] * -cos(pitch));
    forces->gust = (float)value[STRESS_gust];
    forces->gust_period = 2;
    forces->wind_spread = (float)value[STRESS_wind_spread];
    gpu_timer_create(&run->timer, false, true);
    Result result = stress_case_params(strands, &run->params, error);
    if (result != RESULT_OK) return result;
    run->bound = stress_bound_create(strands, &run->params, steps);
    run->step = (SolverStep){.dt = value[STRESS_dt], .first = true, .number = 1};
    run->step.head = run->step.head_old = pose_at(run, 0);
    result = upload(run, gpu, strands, count, error);
    const SolverSetup setup = {.gpu = gpu,
                               .timer = &run->timer,
                               .hair = &run->hair,
                               .params = &run->params,
                               .head = &run->step.head};
    if (result == RESULT_OK) result = solver_create(&run->solver, &setup, error);
    return result == RESULT_OK ? create_check(run, gpu, error) : result;
}

static void keep_positions(Run *run)
{
    const GpuBuffer *positions = &run->hair.batches[0].position;
    solver_pose(&run->solver, &run->step.head_old);
    glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
    glBindBuffer(GL_COPY_READ_BUFFER, positions->buffer);
    glBindBuffer(GL_COPY_WRITE_BUFFER, run->before.buffer);
    glCopyBufferSubData(GL_COPY_READ_BUFFER, GL_COPY_WRITE_BUFFER, 0, 0,
                        (GLsizeiptr)positions->size);
}

static void look(Run *run, int i)
{
    const HairBatch *batch = &run->hair.batches[0];
    StressParams params = {.step = (uint32_t)i,
                           .used_most = (float)run->allowed,
                           .strand_count = batch->strand_count,
                           .vertex_count = batch->vertex_count};
    memcpy(params.gravity, run->step.gravity, sizeof run->step.gravity);
    stress_bound_fill(&run->bound, i == run->steps, &params);
    solver_pose(&run->solver, &run->step.head);
    glMemoryBarrier(GL_TEXTURE_FETCH_BARRIER_BIT | GL_SHADER_STORAGE_BARRIER_BIT);
    gpu_buffer_set_uniforms(&run->uniforms, BIND_STEP, &params, sizeof params);
    gpu_buffer_bind_texture(&batch->position, BIND_POSITION);
    gpu_buffer_bind_texture(&run->before, BIND_STRESS_BEFORE);
    gpu_buffer_bind_texture(&batch->rest, BIND_REST);
    gpu_buffer_bind_storage(&run->worst, BIND_STRESS_WORST);
    gpu_buffer_bind_storage(&run->first, BIND_STRESS_FIRST);
    if (stress_bound_tip_only(run->set)) {
        SolverBuffer buffers[SOLVER_MAX_BUFFERS];
        solver_buffers(&run->solver, 0, buffers);
        gpu_buffer_bind_storage(buffers[1].buffer, BIND_TIPS);
    }
    glUseProgram(run->program);
    glDispatchCompute(step_group_count(batch->strand_count, run->group_size, 1), 1, 1);
    glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT);
}

static void take_step(Run *run, int i)
{
    SolverStep *step = &run->step;
    Forces forces;
    double before[3], now[3], moved[3];
    forces_evaluate(&forces, &run->scene, (i - 1) * step->dt);
    memcpy(step->gravity, forces.gravity, sizeof step->gravity);
    memcpy(step->wind, forces.wind, sizeof step->wind);
    step->head = pose_at(run, i);
    root_at(run, &step->head_old, before);
    root_at(run, &step->head, now);
    for (int k = 0; k < 3; ++k) moved[k] = now[k] - before[k];
    bool turns = i <= run->steps / 2;
    stress_bound_step(&run->bound, moved,
                      turns ? fmin(run->set->value[STRESS_spin] * step->dt, PI) : 0);
    bool looked_at = is_looked_at(run, i);
    if (looked_at) keep_positions(run);
    solver_step(&run->solver, step);
    if (looked_at) look(run, i);
    step->head_old = step->head;
    step->first = false;
    ++step->number;
}

static void read_verdicts(const Run *run, StressVerdict *verdicts, float (*worst)[4],
                          uint32_t (*first)[4], int count)
{
    glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
    glBindBuffer(GL_COPY_READ_BUFFER, run->worst.buffer);
    glGetBufferSubData(GL_COPY_READ_BUFFER, 0, count * (GLsizeiptr)sizeof *worst, worst);
    glBindBuffer(GL_COPY_READ_BUFFER, run->first.buffer);
    glGetBufferSubData(GL_COPY_READ_BUFFER, 0, count * (GLsizeiptr)sizeof *first, first);
    for (int s = 0; s < count; ++s)
        for (int i = 0; i < STRESS_RULES; ++i) {
            verdicts[s].first[i] = (int)first[s][i];
            verdicts[s].worst[i] = i == 0 ? 0 : (double)worst[s][i - 1];
        }
}

static Result take_steps(Run *run, StressVerdict *verdicts, int count, Error *error)
{
    enum { STEPS_IN_FLIGHT = 256 }; // on a GPU, so that it can be interrupted
    for (int i = 1; i <= run->steps; ++i) {
        take_step(run, i);
        if (i % STEPS_IN_FLIGHT == 0) glFinish();
        if (interrupt_requested()) return error_set(error, RESULT_INTERRUPTED, "interrupted");
    }
    float(*worst)[4] = malloc((size_t)count * sizeof *worst);
    uint32_t(*first)[4] = malloc((size_t)count * sizeof *first);
    bool good = worst && first;
    if (good) read_verdicts(run, verdicts, worst, first, count);
    free(worst);
    free(first);
    return good ? RESULT_OK : error_set(error, RESULT_FAILED, "no memory for verdicts");
}

Result stress_run(StressVerdict *verdicts, const Gpu *gpu, const StressCase *strands, int count,
                  int steps, double allowed, Error *error)
{
    Run run;
    Result result = run_create(&run, gpu, strands, count, steps, allowed, error);
    if (result == RESULT_OK) result = take_steps(&run, verdicts, count, error);
    run_destroy(&run);
    return result;
}
