// SPDX-License-Identifier: MIT
#include "bench/stress_run.h"
#include "base/double3.h"
#include "base/interrupt.h"
#include "bench/bench_glsl.h"
#include "bench/stress_bound.h"
#include "gpu/gpu_dispatch.h"
#include "gpu/gpu_uniforms.h"
#include "scene/forces.h"
#include "sim/bound.h"
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
    Scene scene; // for its wind
    GpuTimer timer;
    Solver solver;
    SolverStep step;
    StressBound bound;
    GLuint program;
    const GpuLimits *limits;
    GpuBuffer before, worst, first;
    Mesh sheet; // the mesh that strands are bound to; empty: none
    Body body;  // two samples, before and after a step; their time is the step's number
    BoundBody bound_body;
    Bound strands;
    RigidMotion motion; // motion of the strands' frames at the start of the step
} Run;

static void run_destroy(Run *run)
{
    bound_destroy(&run->strands);
    bound_body_destroy(&run->bound_body);
    body_destroy(&run->body);
    mesh_destroy(&run->sheet);
    solver_destroy(&run->solver);
    hair_destroy(&run->hair);
    params_destroy_section(&run->params);
    gpu_timer_destroy(&run->timer);
    shader_release(run->program);
    gpu_buffer_destroy(&run->before);
    gpu_buffer_destroy(&run->worst);
    gpu_buffer_destroy(&run->first);
}

static Result upload(Run *run, const Gpu *gpu, const StressCase *strands, int count, Error *error)
{
    uint32_t n = (uint32_t)run->set->value[STRESS_n];
    Strands made;
    TRY(strands_create(&made, (uint32_t)count, (uint32_t)count * n, error));
    for (uint32_t s = 0; s < (uint32_t)count; ++s) {
        made.first[s + 1] = (s + 1) * n;
        stress_case_make_strand(&strands[s], &made.position[s * n]);
    }
    Result result = hair_create(&run->hair, &made, (uint32_t)run->set->value[STRESS_strand],
                                &gpu->limits, error);
    strands_destroy(&made);
    return result;
}

// --- The mesh: a sheet around the roots, which are all at the same place.

enum { SHEET_CELLS = 6, SHEET_VERTICES = (SHEET_CELLS + 1) * (SHEET_CELLS + 1) };

static Result make_sheet(Run *run, Error *error)
{
    const double *value = run->set->value, cell = value[STRESS_warp_size] / 10;
    Mesh *sheet = &run->sheet;
    TRY(mesh_create(sheet, SHEET_VERTICES, 2 * SHEET_CELLS * SHEET_CELLS, error));
    for (int v = 0; v < SHEET_VERTICES; ++v) {
        int i = v % (SHEET_CELLS + 1), j = v / (SHEET_CELLS + 1);
        sheet->position[v][0] = (float)(cell * (i - SHEET_CELLS / 2));
        sheet->position[v][1] = (float)value[STRESS_arm];
        sheet->position[v][2] = (float)(cell * (j - SHEET_CELLS / 2));
    }
    for (uint32_t c = 0; c < SHEET_CELLS * SHEET_CELLS; ++c) {
        uint32_t a = c / SHEET_CELLS * (SHEET_CELLS + 1) + c % SHEET_CELLS, b = a + SHEET_CELLS + 1;
        const uint32_t two[2][3] = {{a, b, a + 1}, {a + 1, b, b + 1}};
        memcpy(sheet->triangle[2 * c], two, sizeof two);
    }
    mesh_compute_normals(sheet);
    return RESULT_OK;
}

static Result bind(Run *run, const Gpu *gpu, int count, Error *error)
{
    MeshSequence *sequence = &run->body.sequence;
    float(*roots)[3] = calloc((size_t)count, sizeof *roots);
    size_t size = sizeof *sequence->position * SHEET_VERTICES;
    TRY(make_sheet(run, error));
    *sequence = (MeshSequence){.times = {.count = 2, .rate = 1, .start = -1, .linear = true},
                               .vertex_count = SHEET_VERTICES,
                               .position = malloc(2 * size)};
    run->body.mesh = &run->sheet;
    run->body.name = "sheet";
    run->body.section_count = 1;
    run->body.roots = calloc(1, sizeof *run->body.roots);
    Result result = RESULT_OK;
    if (!roots || !sequence->position || !run->body.roots)
        result = error_set(error, RESULT_FAILED, "no memory for a mesh");
    for (int i = 0; i < 2 && result == RESULT_OK; ++i)
        memcpy(mesh_sequence_at(sequence, (uint32_t)i), run->sheet.position, size);
    for (int s = 0; s < count && result == RESULT_OK; ++s)
        roots[s][1] = (float)run->set->value[STRESS_arm];
    THEN(result, mesh_binding_create(run->body.roots, &run->sheet, "sheet",
                                     (const float(*)[3])roots, (uint32_t)count, error));
    THEN(result, bound_body_create(&run->bound_body, &run->body, error));
    THEN(result, bound_create(&run->strands, &run->bound_body, 0, &run->hair, &gpu->limits, error));
    if (result == RESULT_OK) bound_set(&run->strands, 0, 0);
    run->motion = (RigidMotion){.rotation = {0, 0, 0, 1}};
    free(roots);
    return result;
}

// Moves the mesh to its place after step i and returns the motion of the strands' frames. It stands
// still in the second half.
static RigidMotion warp(Run *run, int i)
{
    int moving = i < run->steps / 2 ? i : run->steps / 2;
    float position[SHEET_VERTICES][3];
    for (int v = 0; v < SHEET_VERTICES; ++v) {
        double rest[3], place[3];
        for (int k = 0; k < 3; ++k) rest[k] = (double)run->sheet.position[v][k];
        stress_case_warp(run->set, moving * run->set->value[STRESS_dt], rest, place);
        for (int k = 0; k < 3; ++k) position[v][k] = (float)place[k];
    }
    mesh_sequence_push(&run->body.sequence, (const float(*)[3])position, i - 1, i);
    const BodyPose *pose = bound_body_pose(&run->bound_body, i);
    return mesh_binding_motion(run->body.roots, 0, (const float(*)[3])pose->position,
                               (const double(*)[4])pose->turn);
}

static Result create_check(Run *run, const Gpu *gpu, Error *error)
{
    const HairBatch *batch = &run->hair.batches[0];
    run->limits = &gpu->limits;
    const ShaderDefine defines[] = {{"GROUP_SIZE", gpu->limits.sizes.strands},
                                    {"TIP", strcmp(run->set->algo, "split") == 0},
                                    {0}};
    int64_t size = (int64_t)hair_slots(batch) * 16;
    void *zero = calloc((size_t)size, 1);
    if (!zero) return error_set(error, RESULT_FAILED, "no memory for verdicts");
    shader_add_sources(BENCH_GLSL_SOURCES);
    Result result = shader_build_compute(&run->program, "bench/stress.comp", defines, error);
    THEN(result, gpu_buffer_create(&run->before, &gpu->limits, "positions before a step",
                                   batch->position.size, NULL, GL_RGBA32F, error));
    THEN(result, gpu_buffer_create(&run->worst, &gpu->limits, "verdicts", size, zero, 0, error));
    THEN(result, gpu_buffer_create(&run->first, &gpu->limits, "verdicts", size, zero, 0, error));
    free(zero);
    return result;
}

// The angle of the head about z after step i, in radians, less than two turns.
static double angle_at(const Run *run, int i)
{
    double moving = i < run->steps / 2 ? i : run->steps / 2;
    return fmod(run->set->value[STRESS_spin] * moving * run->set->value[STRESS_dt], 4 * PI);
}

// The pose of the head after step i: away from the origin, jumping to and fro along x, shaken along
// z, turning about z. The head stands still in the second half.
static HeadPose pose_at(const Run *run, int i)
{
    const double *value = run->set->value;
    int moving = i < run->steps / 2 ? i : run->steps / 2;
    double time = moving * value[STRESS_dt], half = angle_at(run, i) / 2;
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

// The root in the world as float32 has it. In the head's frame it is at (0, arm, 0). `own` is the
// motion of the mesh that it is bound to.
static void root_at(const Run *run, const HeadPose *pose, const RigidMotion *own, double root[3])
{
    if (run->sheet.vertex_count) {
        const double rest[3] = {0, run->set->value[STRESS_arm], 0};
        RigidMotion head = {
            .rotation = {0, 0, (double)pose->rotation[2], (double)pose->rotation[3]}};
        double place[3];
        for (int k = 0; k < 3; ++k) head.translation[k] = (double)pose->translation[k];
        rigid_motion_apply(own, rest, place);
        rigid_motion_apply(&head, place, root);
        for (int k = 0; k < 3; ++k) root[k] = (double)(float)root[k];
        return;
    }
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
    TRY(stress_case_params(strands, &run->params, error));
    run->bound = stress_bound_create(strands, &run->params, steps);
    run->step = (SolverStep){.dt = value[STRESS_dt], .first = true, .number = 1};
    run->step.head = run->step.head_old = pose_at(run, 0);
    TRY(upload(run, gpu, strands, count, error));
    if (value[STRESS_warp] > 0) TRY(bind(run, gpu, count, error));
    float rest_gravity = 0;
    if (run->params.rest == REST_GROOM)
        rest_gravity = (float)(-value[STRESS_gravity] * value[STRESS_rest_share]);
    const SolverSetup setup = {.gpu = gpu,
                               .timer = &run->timer,
                               .hair = &run->hair,
                               .params = &run->params,
                               .head = &run->step.head,
                               .frames = run->strands.frames,
                               .rest_gravity = {0, rest_gravity, 0}};
    TRY(solver_create(&run->solver, &setup, error));
    return create_check(run, gpu, error);
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
    stress_bound_fill(&run->bound, i == run->steps, &params);
    solver_pose(&run->solver, &run->step.head);
    glMemoryBarrier(GL_TEXTURE_FETCH_BARRIER_BIT | GL_SHADER_STORAGE_BARRIER_BIT);
    gpu_uniforms_set(BIND_STEP, &params, sizeof params);
    gpu_buffer_bind_texture(&batch->position, BIND_POSITION);
    gpu_buffer_bind_texture(&run->before, BIND_STRESS_BEFORE);
    gpu_buffer_bind_texture(&batch->rest, BIND_REST);
    gpu_buffer_bind_storage(&run->worst, BIND_STRESS_WORST);
    gpu_buffer_bind_storage(&run->first, BIND_STRESS_FIRST);
    if (strcmp(run->set->algo, "split") == 0) {
        SolverBuffer buffers[SOLVER_MAX_BUFFERS];
        solver_buffers(&run->solver, 0, buffers);
        gpu_buffer_bind_storage(buffers[1].buffer, BIND_TIPS);
    }
    glUseProgram(run->program);
    gpu_dispatch(run->limits, batch->strand_count, (uint64_t)run->limits->sizes.strands, 1);
    glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT);
}

static void take_step(Run *run, int i)
{
    SolverStep *step = &run->step;
    Forces forces;
    double before[3], now[3];
    StressMove move = {.turned = angle_at(run, i)};
    forces_evaluate(&forces, &run->scene, (i - 1) * step->dt);
    memcpy(step->gravity, forces.gravity, sizeof step->gravity);
    memcpy(step->wind, forces.wind, sizeof step->wind);
    step->head = pose_at(run, i);
    RigidMotion own = run->motion;
    if (run->sheet.vertex_count) {
        own = warp(run, i);
        const double *a = run->motion.rotation, *b = own.rotation;
        double along = a[0] * b[0] + a[1] * b[1] + a[2] * b[2] + a[3] * b[3];
        move.warp = 2 * acos(fmin(fabs(along), 1));
        memcpy(move.warped, own.rotation, sizeof move.warped);
        step->shape_old = bound_body_shape(&run->bound_body, i - 1);
        step->shape = bound_body_shape(&run->bound_body, i);
    }
    root_at(run, &step->head_old, &run->motion, before);
    root_at(run, &step->head, &own, now);
    run->motion = own;
    for (int k = 0; k < 3; ++k) {
        move.moved[k] = now[k] - before[k];
        move.gravity[k] = (double)step->gravity[k];
    }
    bool turns = i <= run->steps / 2;
    move.angle = turns ? fmin(run->set->value[STRESS_spin] * step->dt, PI) : 0;
    stress_bound_step(&run->bound, &move);
    bool looked_at = is_looked_at(run, i);
    bound_set_after(&run->strands, i - 1);
    if (looked_at) keep_positions(run);
    if (run->sheet.vertex_count) bound_set(&run->strands, i - 1, i);
    solver_step(&run->solver, step);
    if (looked_at) look(run, i);
    step->head_old = step->head;
    step->first = false;
    ++step->number;
}

Result stress_run(StressVerdict *verdicts, const Gpu *gpu, const StressCase *strands, int count,
                  int steps, double allowed, Error *error)
{
    enum { STEPS_IN_FLIGHT = 256 }; // limits queued work on a GPU, so that interrupts are seen soon
    Run run;
    Result result = run_create(&run, gpu, strands, count, steps, allowed, error);
    for (int i = 1; i <= steps && result == RESULT_OK; ++i) {
        take_step(&run, i);
        if (i % STEPS_IN_FLIGHT == 0) glFinish();
        if (interrupt_requested()) result = error_set(error, RESULT_INTERRUPTED, "interrupted");
    }
    glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
    for (int s = 0; s < count && result == RESULT_OK; ++s) {
        float worst[4];
        uint32_t first[4];
        GLintptr at = s * (GLintptr)sizeof worst;
        glBindBuffer(GL_COPY_READ_BUFFER, run.worst.buffer);
        glGetBufferSubData(GL_COPY_READ_BUFFER, at, sizeof worst, worst);
        glBindBuffer(GL_COPY_READ_BUFFER, run.first.buffer);
        glGetBufferSubData(GL_COPY_READ_BUFFER, at, sizeof first, first);
        verdicts[s].flutters = worst[3] > 0;
        for (int i = 0; i < STRESS_RULES; ++i) {
            verdicts[s].first[i] = (int)first[i];
            verdicts[s].worst[i] = i == 0 ? 0 : (double)worst[i - 1];
        }
    }
    run_destroy(&run);
    return result;
}
