// SPDX-License-Identifier: MIT
#include "sim/particle_solver.h"
#include "sim/collision.h"
#include "sim/pose.h"
#include "sim/step_programs.h"

#include <cglm/cglm.h>

#include <assert.h>
#include <stdlib.h>
#include <string.h>

typedef struct ParticleBatch {
    GpuBuffer velocity; // vec4 a particle: m/s; w is the solver's own
    GpuBuffer scratch;
} ParticleBatch;

typedef struct ParticleState {
    const ParticleRecipe *recipe;
    const Hair *hair;
    const SectionParams *params;
    GpuTimer *timer;
    GpuBuffer uniforms;
    StepPrograms programs;
    ParticleBatch *batches; // one for each of the hair
    Pose style;             // for the start
    Collision collision;
    bool posed;
} ParticleState;

static void destroy(void *pointer)
{
    ParticleState *state = pointer;
    if (!state) return;
    for (uint32_t i = 0; state->batches && i < state->hair->batch_count; ++i) {
        gpu_buffer_destroy(&state->batches[i].velocity);
        gpu_buffer_destroy(&state->batches[i].scratch);
    }
    free(state->batches);
    step_programs_destroy(&state->programs);
    gpu_buffer_destroy(&state->uniforms);
    pose_destroy(&state->style);
    collision_destroy(&state->collision);
    free(state);
}

const GpuBuffer *particle_solver_velocities(const void *pointer, uint32_t batch)
{
    const ParticleState *state = pointer;
    return &state->batches[batch].velocity;
}

static Result build_programs(ParticleState *state, const SolverSetup *setup, Error *error)
{
    ShaderDefine defines[STEP_OWN_DEFINES + 1] = {0};
    if (state->recipe->define) state->recipe->define(defines, state->params);
    const StepProgramsOptions options = {
        .shader = state->recipe->shader,
        .most_in_registers = state->recipe->most_in_registers,
        .strands_on_cpu = 1,
        .lead = state->recipe->carried < 2 && state->params->clamped > 1,
        .sheltered = setup->sheltered,
        .defines = defines,
    };
    return step_programs_create(&state->programs, setup->gpu, state->hair, &options, error);
}

static Result create_buffers(ParticleState *state, ParticleBatch *batch, const HairBatch *hair,
                             const GpuLimits *limits, Error *error)
{
    size_t particles = (size_t)hair->vertex_count * hair_slots(hair);
    float *zero = calloc(particles, 4 * sizeof *zero);
    assert(state->recipe->scratch <= HAIR_MOST_SCRATCH);
    if (!zero) return error_set(error, RESULT_FAILED, "no memory for %zu particles", particles);
    int64_t size = (int64_t)(particles * 4 * sizeof *zero);
    Result result =
        gpu_buffer_create(&batch->velocity, limits, "velocities", size, zero, GL_RGBA32F, error);
    free(zero);
    if (result == RESULT_OK && state->recipe->scratch && !state->programs.in_registers)
        result = gpu_buffer_create(&batch->scratch, limits, "a solver's scratch memory",
                                   size * state->recipe->scratch, NULL, 0, error);
    return result;
}

static Result check_vertices(const Hair *hair, const ParticleRecipe *recipe, Error *error)
{
    for (uint32_t i = 0; i < hair->batch_count; ++i)
        if (recipe->most_vertices && hair->batches[i].vertex_count > recipe->most_vertices)
            return error_set(
                error, RESULT_USAGE,
                "%s: takes strands of at most %u vertices, got %u (a step's loops have "
                "65,535 rounds in all)",
                recipe->label + strlen("sim_"), recipe->most_vertices,
                hair->batches[i].vertex_count);
    return RESULT_OK;
}

static const ParticleRecipe *find_recipe(const SolverSetup *setup)
{
    const SolverType *type = setup->type;
    const ParticleRecipe *own = type->recipes[solver_variant(type, setup->params->variant)];
    return own ? own : type->recipes[0];
}

static Result check(const SolverSetup *setup, const ParticleRecipe *recipe, Error *error)
{
    Result result = check_vertices(setup->hair, recipe, error);
    return result == RESULT_OK && recipe->check ? recipe->check(setup, error) : result;
}

static Result build(ParticleState *state, const SolverSetup *setup, Error *error)
{
    state->batches = calloc(setup->hair->batch_count + 1, sizeof *state->batches);
    if (!state->batches) return error_set(error, RESULT_FAILED, "no memory for a solver");
    Result result = build_programs(state, setup, error);
    if (result == RESULT_OK) result = pose_create(&state->style, setup->gpu, 1, error);
    if (result == RESULT_OK)
        result = collision_create(&state->collision, setup, COLLISION_PARTICLES,
                                  state->params->clamped > 1 ? 2 : state->recipe->carried, error);
    for (uint32_t i = 0; i < state->hair->batch_count && result == RESULT_OK; ++i)
        result = create_buffers(state, &state->batches[i], &state->hair->batches[i],
                                &setup->gpu->limits, error);
    return result;
}

static Result create(void **pointer, const SolverSetup *setup, Error *error)
{
    *pointer = NULL;
    const ParticleRecipe *recipe = find_recipe(setup);
    Result result = check(setup, recipe, error);
    if (result != RESULT_OK) return result;
    ParticleState *state = calloc(1, sizeof *state);
    if (!state) return error_set(error, RESULT_FAILED, "no memory for a solver");
    *state = (ParticleState){
        .recipe = recipe, .hair = setup->hair, .params = setup->params, .timer = setup->timer};
    result = build(state, setup, error);
    if (result == RESULT_OK)
        *pointer = state;
    else
        destroy(state);
    return result;
}

static void write_pose(void *pointer, const HeadPose *head)
{
    ParticleState *state = pointer;
    if (state->posed) return;
    for (uint32_t i = 0; i < state->hair->batch_count; ++i)
        pose_write(&state->style, &state->hair->batches[i], NULL, head);
    state->posed = true;
}

static void dispatch(ParticleState *state, uint32_t i, StepParams *uniforms)
{
    const HairBatch *hair = &state->hair->batches[i];
    const ParticleBatch *batch = &state->batches[i];
    uniforms->strand_count = hair->strand_count;
    uniforms->vertex_count = hair->vertex_count - state->programs.leads[i];
    gpu_buffer_set_uniforms(&state->uniforms, BIND_STEP, uniforms, sizeof *uniforms);
    gpu_buffer_bind_texture(&hair->position, BIND_POSITION);
    gpu_buffer_bind_texture(&hair->rest, BIND_REST);
    gpu_buffer_bind_texture(&hair->strand_id, BIND_STRAND_ID);
    gpu_buffer_bind_texture(&batch->velocity, BIND_STATE);
    gpu_buffer_bind_storage(&hair->position, BIND_POSITION_OUT);
    gpu_buffer_bind_storage(&batch->velocity, BIND_STATE_OUT);
    if (batch->scratch.buffer) gpu_buffer_bind_storage(&batch->scratch, BIND_SCRATCH);
    step_programs_dispatch(&state->programs, i, hair->strand_count);
}

static int list_buffers(const void *pointer, uint32_t batch,
                        SolverBuffer buffers[SOLVER_MAX_BUFFERS])
{
    const ParticleState *state = pointer;
    buffers[0] = (SolverBuffer){&state->hair->batches[batch].position, SOLVER_POINTS};
    buffers[1] = (SolverBuffer){&state->batches[batch].velocity, SOLVER_VELOCITIES};
    const GpuBuffer *contacts = collision_memory(&state->collision, batch);
    if (contacts) buffers[2] = (SolverBuffer){contacts, SOLVER_POINTS};
    return contacts ? 3 : 2;
}

// The head's pose after the share t of a step: translation straight, rotation by slerp.
static HeadPose pose_between(const HeadPose *a, const HeadPose *b, float t)
{
    HeadPose pose = {0};
    if (t >= 1) return *b;
    glm_quat_slerp((float *)a->rotation, (float *)b->rotation, t, pose.rotation);
    glm_vec3_lerp((float *)a->translation, (float *)b->translation, t, pose.translation);
    return pose;
}

static void dispatch_phases(ParticleState *state, StepParams *uniforms)
{
    const ParticleRecipe *recipe = state->recipe;
    int phases = recipe->phases && !state->programs.in_registers
                     ? recipe->phases(state->params, state->hair)
                     : 1;
    for (int phase = 0; phase < phases; ++phase) {
        uniforms->phase = (uint32_t)phase;
        for (uint32_t i = 0; i < state->hair->batch_count; ++i) dispatch(state, i, uniforms);
        glMemoryBarrier(GL_TEXTURE_FETCH_BARRIER_BIT | GL_SHADER_STORAGE_BARRIER_BIT);
    }
}

static void collide(ParticleState *state, const SolverStep *step, int part, int parts)
{
    if (!collision_begin(&state->collision, step, part, parts)) return;
    for (uint32_t i = 0; i < state->hair->batch_count; ++i)
        collision_push(&state->collision, i, &state->batches[i].velocity, NULL);
}

static void step_hair(void *pointer, const SolverStep *whole)
{
    ParticleState *state = pointer;
    const ParticleRecipe *recipe = state->recipe;
    write_pose(state, &whole->head_old);
    int count = recipe->substeps ? recipe->substeps(whole, state->params, state->hair) : 1;
    gpu_timer_begin(state->timer, recipe->label);
    SolverStep step = *whole;
    step.dt = whole->dt / count;
    for (int part = 1; part <= count; ++part) {
        step.head = pose_between(&whole->head_old, &whole->head, (float)part / (float)count);
        StepParams uniforms = step_uniforms(&step, state->params);
        if (recipe->fill) recipe->fill(&uniforms, &step, state->params);
        dispatch_phases(state, &uniforms);
        collide(state, &step, part, count);
        step.head_old = step.head;
        step.first = false;
    }
    gpu_timer_end(state->timer);
}

static void report(void *pointer, SolverReport *solver_report)
{
    const ParticleState *state = pointer;
    collision_report(&state->collision, solver_report);
}

const SolverCalls PARTICLE_SOLVER = {
    .create = create,
    .buffers = list_buffers,
    .step = step_hair,
    .pose = write_pose,
    .report = report,
    .destroy = destroy,
};
