// SPDX-License-Identifier: MIT
#include "sim/pose.h"
#include "sim/solver.h"

#include <stdlib.h>

typedef struct NoneState {
    const Hair *hair;
    GpuTimer *timer;
    Pose pose;
} NoneState;

static void destroy(void *pointer)
{
    NoneState *state = pointer;
    if (!state) return;
    pose_destroy(&state->pose);
    free(state);
}

static Result create(void **pointer, const SolverSetup *setup, Error *error)
{
    NoneState *state = calloc(1, sizeof *state);
    if (!state) return error_set(error, RESULT_FAILED, "no memory for a solver");
    state->hair = setup->hair;
    state->timer = setup->timer;
    Result result = pose_create(&state->pose, setup->gpu, 1, error);
    if (result != RESULT_OK) {
        destroy(state);
        state = NULL;
    }
    *pointer = state;
    return result;
}

static void write_pose(void *pointer, const HeadPose *head)
{
    NoneState *state = pointer;
    gpu_timer_begin(state->timer, "pose");
    for (uint32_t i = 0; i < state->hair->batch_count; ++i)
        pose_write(&state->pose, &state->hair->batches[i], NULL, head);
    gpu_timer_end(state->timer);
}

static const SolverCalls CALLS = {.create = create, .pose = write_pose, .destroy = destroy};

const SolverType SOLVER_NONE = {
    .name = "none",
    .summary = "hair stiff in its style, carried by the head",
    .lengths = "exact",
    .style = "rigid",
    .calls = &CALLS,
};
