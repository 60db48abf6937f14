// SPDX-License-Identifier: MIT
#include "sim/gather.h"

#include "glsl/sim/gather_params.h"

#include <stdlib.h>

static Result upload_begins(Gather *gather, const GpuLimits *limits, const uint32_t *first,
                            Error *error)
{
    const Hair *hair = gather->hair;
    gather->begins = calloc((size_t)hair->batch_count + 1, sizeof *gather->begins);
    if (!gather->begins) return error_set(error, RESULT_FAILED, "no memory for places of strands");
    for (uint32_t i = 0; i < hair->batch_count; first += hair->batches[i++].strand_count)
        TRY(gpu_buffer_create(&gather->begins[i], limits, "places of strands",
                              4 * (int64_t)hair->batches[i].strand_count, first, GL_R32UI, error));
    return RESULT_OK;
}

Result gather_create(Gather *gather, const Gpu *gpu, const Hair *hair, const uint32_t *first,
                     Error *error)
{
    *gather = (Gather){.hair = hair};
    glGetIntegerv(GL_SHADER_STORAGE_BUFFER_OFFSET_ALIGNMENT, &gather->alignment);
    int64_t most = gather->alignment + 4 * (int64_t)sizeof(float) * (int64_t)hair->particle_count;
    if (most > gpu->limits.storage_block)
        return error_set(error, RESULT_FAILED,
                         "%lld bytes of positions: expected at most %lld, the limit of this driver",
                         (long long)most, (long long)gpu->limits.storage_block);
    Result result = step_pass_create(&gather->pass, gpu, "sim/gather.comp", NULL, error);
    THEN(result, upload_begins(gather, &gpu->limits, first, error));
    if (result != RESULT_OK) gather_destroy(gather);
    return result;
}

void gather_destroy(Gather *gather)
{
    for (uint32_t i = 0; gather->begins && i < gather->hair->batch_count; ++i)
        gpu_buffer_destroy(&gather->begins[i]);
    free(gather->begins);
    step_pass_destroy(&gather->pass);
    *gather = (Gather){0};
}

void gather_run(Gather *gather, GLuint buffer, int64_t offset)
{
    const Hair *hair = gather->hair;
    int64_t start = gather->alignment > 0 ? offset / gather->alignment * gather->alignment : offset,
            vertex = 4 * (int64_t)sizeof(float);
    GatherParams params = {.begin = (uint32_t)((offset - start) / vertex)};
    glBindBufferRange(GL_SHADER_STORAGE_BUFFER, BIND_POSITION_OUT, buffer, (GLintptr)start,
                      (GLsizeiptr)(offset - start + vertex * (int64_t)hair->particle_count));
    for (uint32_t i = 0; i < hair->batch_count; ++i) {
        const HairBatch *batch = &hair->batches[i];
        params.strand_count = batch->strand_count;
        params.vertex_count = batch->vertex_count;
        gpu_buffer_bind_texture(&batch->position, BIND_POSITION);
        gpu_buffer_bind_texture(&gather->begins[i], BIND_STRAND_ID);
        step_pass_run(&gather->pass, &params, sizeof params, batch->strand_count);
    }
    glMemoryBarrier(GL_VERTEX_ATTRIB_ARRAY_BARRIER_BIT | GL_SHADER_STORAGE_BARRIER_BIT |
                    GL_TEXTURE_FETCH_BARRIER_BIT | GL_BUFFER_UPDATE_BARRIER_BIT);
}
