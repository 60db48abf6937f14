// SPDX-License-Identifier: MIT
#include "sim/inbetween.h"

#include "glsl/sim/inbetween_params.h"

#include <stdlib.h>
#include <string.h>

static Result create_copies(GpuBuffer **copies, const Hair *hair, const GpuLimits *limits,
                            Error *error)
{
    *copies = calloc((size_t)hair->batch_count + 1, sizeof **copies);
    if (!*copies) return error_set(error, RESULT_FAILED, "no memory for frames between steps");
    for (uint32_t i = 0; i < hair->batch_count; ++i)
        TRY(gpu_buffer_create(&(*copies)[i], limits, "hair positions between steps",
                              hair->batches[i].position.size, NULL, GL_RGBA32F, error));
    return RESULT_OK;
}

Result inbetween_create(Inbetween *inbetween, const Gpu *gpu, const Hair *hair,
                        const GpuBuffer *frames, Error *error)
{
    *inbetween = (Inbetween){.hair = hair, .frames = frames};
    const ShaderDefine defines[] = {{"BOUND", frames != NULL}, {0}};
    Result result = step_pass_create(&inbetween->pass, gpu, "sim/inbetween.comp", defines, error);
    THEN(result, create_copies(&inbetween->earlier, hair, &gpu->limits, error));
    THEN(result, create_copies(&inbetween->later, hair, &gpu->limits, error));
    if (result != RESULT_OK) inbetween_destroy(inbetween);
    return result;
}

static void destroy_copies(GpuBuffer *copies, const Hair *hair)
{
    for (uint32_t i = 0; copies && i < hair->batch_count; ++i) gpu_buffer_destroy(&copies[i]);
    free(copies);
}

void inbetween_destroy(Inbetween *inbetween)
{
    destroy_copies(inbetween->earlier, inbetween->hair);
    destroy_copies(inbetween->later, inbetween->hair);
    step_pass_destroy(&inbetween->pass);
    *inbetween = (Inbetween){0};
}

static void copy(const GpuBuffer *from, const GpuBuffer *to)
{
    glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
    glBindBuffer(GL_COPY_READ_BUFFER, from->buffer);
    glBindBuffer(GL_COPY_WRITE_BUFFER, to->buffer);
    glCopyBufferSubData(GL_COPY_READ_BUFFER, GL_COPY_WRITE_BUFFER, 0, 0, (GLsizeiptr)from->size);
}

void inbetween_keep(Inbetween *inbetween, bool later)
{
    for (uint32_t i = 0; i < inbetween->hair->batch_count; ++i)
        copy(&inbetween->hair->batches[i].position,
             later ? &inbetween->later[i] : &inbetween->earlier[i]);
}

void inbetween_mix(Inbetween *inbetween, float share, const HeadPose *earlier,
                   const HeadPose *later, const HeadPose *now)
{
    InbetweenParams params = {.share = share};
    head_put(params.earlier_rotation, params.earlier_translation, earlier);
    head_put(params.later_rotation, params.later_translation, later);
    head_put(params.now_rotation, params.now_translation, now);
    for (uint32_t i = 0; i < inbetween->hair->batch_count; ++i) {
        const HairBatch *batch = &inbetween->hair->batches[i];
        params.strand_count = batch->strand_count;
        params.vertex_count = batch->vertex_count;
        gpu_buffer_bind_texture(&inbetween->earlier[i], BIND_POSITION);
        gpu_buffer_bind_texture(&inbetween->later[i], BIND_STATE);
        if (inbetween->frames) gpu_buffer_bind_texture(&inbetween->frames[i], BIND_FRAMES);
        gpu_buffer_bind_storage(&batch->position, BIND_POSITION_OUT);
        step_pass_run(&inbetween->pass, &params, sizeof params, batch->strand_count);
    }
    glMemoryBarrier(GL_TEXTURE_FETCH_BARRIER_BIT | GL_SHADER_STORAGE_BARRIER_BIT);
    inbetween->mixed = true;
}

void inbetween_restore(Inbetween *inbetween)
{
    if (!inbetween->mixed) return;
    for (uint32_t i = 0; i < inbetween->hair->batch_count; ++i)
        copy(&inbetween->later[i], &inbetween->hair->batches[i].position);
    inbetween->mixed = false;
}
