// SPDX-License-Identifier: MIT
#include "sim/collision.h"
#include "sim/pose.h"
#include "sim/solver.h"
#include "sim/step_programs.h"
#include "sim/step_uniforms.h"

#include <cglm/cglm.h>

#include <stdlib.h>
#include <string.h>

// A strand of at most this many vertices stays in registers for a whole step; its shader is
// compiled for that count.
enum { MOST_IN_REGISTERS = 40 };

// Strands of a lane on a CPU driver, where two hide each other's latency.
enum { STRANDS_ON_CPU = 2 };

// A strand in memory takes six loops over its segments at most (span, four pulls, renormalisation),
// and CPU drivers end loops silently after 65,535 iterations in all of an invocation: longer
// strands are refused.
enum { MOST_VERTICES = 10000 };

typedef struct SplitBatch {
    GpuBuffer segments; // vec4 a particle: unit direction in the world, rest length (j = 0: unused)
    GpuBuffer tips;     // two vec4 a strand: position (m), times limited; velocity (m/s)
} SplitBatch;

typedef struct SplitState {
    const Hair *hair;
    const SectionParams *params;
    GpuTimer *timer;
    GpuBuffer uniforms;
    SplitBatch *batches; // one for each of the hair
    Pose pose;
    StepPrograms programs;
    Collision collision, drawn; // of the physical strands, of what is drawn
    bool thesis, dragged;
} SplitState;

static void destroy(void *pointer)
{
    SplitState *state = pointer;
    if (!state) return;
    for (uint32_t i = 0; state->batches && i < state->hair->batch_count; ++i) {
        SplitBatch *batch = &state->batches[i];
        gpu_buffer_destroy(&batch->segments);
        gpu_buffer_destroy(&batch->tips);
    }
    free(state->batches);
    step_programs_destroy(&state->programs);
    gpu_buffer_destroy(&state->uniforms);
    pose_destroy(&state->pose);
    collision_destroy(&state->collision);
    collision_destroy(&state->drawn);
    free(state);
}

static Result build_programs(SplitState *state, const SolverSetup *setup, Error *error)
{
    const StepProgramsOptions options = {
        .shader = "sim/split.comp",
        .most_in_registers = MOST_IN_REGISTERS,
        .strands_on_cpu = STRANDS_ON_CPU,
        .lead = state->params->clamped > 1,
        .sheltered = setup->sheltered,
        .defines =
            (const ShaderDefine[]){{"THESIS", state->thesis}, {"DRAGGED", state->dragged}, {0}},
    };
    return step_programs_create(&state->programs, setup->gpu, state->hair, &options, error);
}

typedef float Float4[4];

// The strand's texels of `rest` become directions in the world; the tip is at their end.
static void place_strand(const HairBatch *hair, uint32_t slot, const HeadPose *head, Float4 *rest,
                         Float4 tip)
{
    for (uint32_t j = 0; j < hair->vertex_count; ++j) {
        float *at = rest[hair_address(hair, slot, j)];
        if (head) glm_quat_rotatev((float *)head->rotation, at, at);
        if (head && j == 0) glm_vec3_add((float *)head->translation, at, at);
        for (int k = 0; k < 3; ++k) tip[k] += j == 0 ? at[k] : at[3] * at[k];
    }
}

// At rest in the style where the head is.
static Result create_state(SplitBatch *batch, const HairBatch *hair, const SolverSetup *setup,
                           Error *error)
{
    const GpuLimits *limits = &setup->gpu->limits;
    uint32_t slots = hair_slots(hair);
    size_t particles = (size_t)hair->vertex_count * slots;
    Float4 *rest = malloc(particles * sizeof *rest),
           *tips = calloc(2 * (size_t)slots, sizeof *tips);
    Result result = RESULT_FAILED;
    if (rest && tips) {
        glBindBuffer(GL_SHADER_STORAGE_BUFFER, hair->rest.buffer);
        glGetBufferSubData(GL_SHADER_STORAGE_BUFFER, 0, (GLsizeiptr)(particles * sizeof *rest),
                           rest);
        for (uint32_t slot = 0; slot < slots; ++slot)
            place_strand(hair, slot, setup->head, rest, tips[2 * slot]);
        result = gpu_buffer_create(&batch->segments, limits, "split's segments",
                                   (int64_t)(particles * sizeof *rest), rest, GL_RGBA32F, error);
        if (result == RESULT_OK)
            result = gpu_buffer_create(&batch->tips, limits, "split's tips", 32 * (int64_t)slots,
                                       tips, 0, error);
    } else {
        error_set(error, RESULT_FAILED, "no memory for %zu particles", particles);
    }
    free(rest);
    free(tips);
    return result;
}

static Result check_lengths(const Hair *hair, Error *error)
{
    for (uint32_t i = 0; i < hair->batch_count; ++i)
        if (hair->batches[i].vertex_count > MOST_VERTICES)
            return error_set(error, RESULT_USAGE,
                             "split: a strand of %u vertices; it takes at most %d (rope, spring "
                             "and dftl take more)",
                             hair->batches[i].vertex_count, MOST_VERTICES);
    return RESULT_OK;
}

static Result build(SplitState *state, const SolverSetup *setup, Error *error)
{
    state->batches =
        calloc(state->hair->batch_count ? state->hair->batch_count : 1, sizeof *state->batches);
    if (!state->batches) return error_set(error, RESULT_FAILED, "no memory for a solver");
    Result result = check_lengths(state->hair, error);
    if (result == RESULT_OK) result = build_programs(state, setup, error);
    if (result == RESULT_OK)
        result = pose_create(&state->pose, setup->gpu, setup->params->style, error);
    uint32_t carried = state->params->clamped > 1 ? 2 : 1;
    if (result == RESULT_OK)
        result = collision_create(&state->collision, setup, COLLISION_SEGMENTS, carried, error);
    if (result == RESULT_OK)
        result = collision_create(&state->drawn, setup, COLLISION_DRAWN, carried, error);
    for (uint32_t i = 0; i < state->hair->batch_count && result == RESULT_OK; ++i)
        result = create_state(&state->batches[i], &state->hair->batches[i], setup, error);
    return result;
}

static Result create(void **pointer, const SolverSetup *setup, Error *error)
{
    SplitState *state = calloc(1, sizeof *state);
    *pointer = NULL;
    if (!state) return error_set(error, RESULT_FAILED, "no memory for a solver");
    state->hair = setup->hair;
    state->params = setup->params;
    state->timer = setup->timer;
    state->thesis = strcmp(setup->params->variant, "thesis") == 0;
    state->dragged = state->thesis || strcmp(setup->params->variant, "dragged") == 0;
    Result result = build(state, setup, error);
    if (result == RESULT_OK)
        *pointer = state;
    else
        destroy(state);
    return result;
}

static int list_buffers(const void *pointer, uint32_t batch,
                        SolverBuffer buffers[SOLVER_MAX_BUFFERS])
{
    const SplitState *state = pointer;
    buffers[0] = (SolverBuffer){&state->batches[batch].segments, SOLVER_DIRECTIONS};
    buffers[1] = (SolverBuffer){&state->batches[batch].tips, SOLVER_TIPS};
    const GpuBuffer *contacts = collision_memory(&state->collision, batch);
    if (contacts) buffers[2] = (SolverBuffer){contacts, SOLVER_POINTS};
    return contacts ? 3 : 2;
}

static void step(void *pointer, const SolverStep *solver_step)
{
    SplitState *state = pointer;
    StepParams uniforms = step_uniforms(solver_step, state->params);
    uniforms.passes = state->thesis ? 2 : 4;
    gpu_timer_begin(state->timer, "sim_split");
    for (uint32_t i = 0; i < state->hair->batch_count; ++i) {
        const HairBatch *hair = &state->hair->batches[i];
        const SplitBatch *batch = &state->batches[i];
        uniforms.strand_count = hair->strand_count;
        uniforms.vertex_count = hair->vertex_count - state->programs.leads[i];
        gpu_buffer_set_uniforms(&state->uniforms, BIND_STEP, &uniforms, sizeof uniforms);
        gpu_buffer_bind_texture(&hair->rest, BIND_REST);
        gpu_buffer_bind_texture(&hair->strand_id, BIND_STRAND_ID);
        gpu_buffer_bind_texture(&batch->segments, BIND_STATE);
        gpu_buffer_bind_storage(&batch->segments, BIND_STATE_OUT);
        gpu_buffer_bind_storage(&batch->tips, BIND_TIPS);
        step_programs_dispatch(&state->programs, i, hair->strand_count);
    }
    glMemoryBarrier(GL_TEXTURE_FETCH_BARRIER_BIT | GL_SHADER_STORAGE_BARRIER_BIT);
    if (collision_begin(&state->collision, solver_step, 1, 1))
        for (uint32_t i = 0; i < state->hair->batch_count; ++i)
            collision_push(&state->collision, i, &state->batches[i].segments,
                           &state->batches[i].tips);
    gpu_timer_end(state->timer);
}

static void write_pose(void *pointer, const HeadPose *head)
{
    SplitState *state = pointer;
    gpu_timer_begin(state->timer, "pose");
    for (uint32_t i = 0; i < state->hair->batch_count; ++i)
        pose_write(&state->pose, &state->hair->batches[i], &state->batches[i].segments, head);
    collision_push_drawn(&state->drawn, head);
    gpu_timer_end(state->timer);
}

static void report(void *pointer, SolverReport *solver_report)
{
    const SplitState *state = pointer;
    collision_report(&state->collision, solver_report);
    for (uint32_t i = 0; i < state->hair->batch_count; ++i) {
        uint32_t count = state->hair->batches[i].strand_count;
        Float4 *tips = malloc(2 * (size_t)count * sizeof *tips);
        if (!tips) return;
        glBindBuffer(GL_SHADER_STORAGE_BUFFER, state->batches[i].tips.buffer);
        glGetBufferSubData(GL_SHADER_STORAGE_BUFFER, 0,
                           (GLsizeiptr)(2 * (size_t)count * sizeof *tips), tips);
        for (uint32_t s = 0; s < count; ++s)
            solver_report->moves_limited += (uint64_t)tips[2 * s][3];
        free(tips);
    }
}

static const SolverCalls CALLS = {
    .create = create,
    .buffers = list_buffers,
    .step = step,
    .pose = write_pose,
    .report = report,
    .destroy = destroy,
};

const SolverType SOLVER_SPLIT = {
    .name = "split",
    .summary =
        "the tip is simulated, the strand follows it as tractrices, the style is mixed back in",
    .lengths = "exact",
    .style = "mixed into what is drawn, --style",
    .variants = {"ball", "dragged", "thesis"},
    .calls = &CALLS,
};
