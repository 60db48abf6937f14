// SPDX-License-Identifier: MIT
#include "sim/carry.h"
#include "gpu/gpu_dispatch.h"
#include "gpu/gpu_uniforms.h"

#include "glsl/sim/carry_params.h"

#include <string.h>

Result carry_create(Carry *carry, const GpuLimits *limits, bool bound, Error *error)
{
    *carry = (Carry){.limits = limits};
    const ShaderDefine defines[] = {{"GROUP_SIZE", limits->sizes.items}, {"BOUND", bound}, {0}};
    return shader_build_compute(&carry->program, "sim/carry.comp", defines, error);
}

void carry_destroy(Carry *carry)
{
    shader_release(carry->program);
    *carry = (Carry){0};
}

static void carry_buffer(Carry *carry, CarryParams params, const SolverBuffer *buffer)
{
    if (buffer->kind == SOLVER_POINTS) return; // follow with the velocities
    const SolverBuffer *points = buffer->kind == SOLVER_VELOCITIES ? buffer - 1 : buffer;
    params.stride = buffer->kind == SOLVER_TIPS ? 2 : 1;
    params.beside = buffer->kind == SOLVER_TIPS;
    params.directions = buffer->kind == SOLVER_DIRECTIONS;
    params.count = (uint)(buffer->buffer->size / (int64_t)sizeof(vec4)) / params.stride;
    gpu_uniforms_set(BIND_STEP, &params, sizeof params);
    gpu_buffer_bind_storage(points->buffer, BIND_POSITION_OUT);
    gpu_buffer_bind_storage(buffer->buffer, BIND_STATE_OUT);
    glUseProgram(carry->program);
    gpu_dispatch(carry->limits, params.count, (uint64_t)carry->limits->sizes.items, 1);
}

void carry_apply(Carry *carry, const Solver *solver, const Hair *hair, const HeadMotion *motion,
                 const GpuBuffer *frames)
{
    CarryParams params = {0};
    memcpy(params.rotation, motion->rotation, sizeof motion->rotation);
    memcpy(params.translation, motion->translation, sizeof motion->translation);
    memcpy(params.velocity, motion->velocity, sizeof motion->velocity);
    memcpy(params.spin, motion->spin, sizeof motion->spin);
    glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT);
    for (uint32_t batch = 0; batch < hair->batch_count; ++batch) {
        SolverBuffer buffers[SOLVER_MAX_BUFFERS];
        if (frames) gpu_buffer_bind_texture(&frames[batch], BIND_FRAMES);
        params.vertex_count = hair->batches[batch].vertex_count;
        int count = solver_buffers(solver, batch, buffers);
        for (int i = 0; i < count; ++i) carry_buffer(carry, params, &buffers[i]);
    }
    glMemoryBarrier(GL_TEXTURE_FETCH_BARRIER_BIT | GL_SHADER_STORAGE_BARRIER_BIT);
}
