// SPDX-License-Identifier: MIT
#include "draw/hair_paint.h"

#include <assert.h>
#include <stdlib.h>
#include <string.h>

typedef uint32_t Texel[4];

static uint32_t unorm16(float x)
{
    return (uint32_t)(x * 65535.0f + 0.5f);
}

static void fill(Texel *texels, const HairBatch *batch, const Strands *strands, const Paint *paint)
{
    for (uint32_t slot = 0; slot < hair_slots(batch); ++slot) {
        uint32_t s = batch->strand[slot < batch->strand_count ? slot : batch->strand_count - 1];
        for (uint32_t j = 0; j < batch->vertex_count; ++j) {
            uint32_t *texel = texels[hair_address(batch, slot, j)], v = strands->first[s] + j;
            const float *c = paint->color[v];
            texel[0] = unorm16(c[0]) | unorm16(c[1]) << 16;
            texel[1] = unorm16(c[2]) | unorm16(c[3]) << 16;
            memcpy(&texel[2], &paint->thickness[v], sizeof texel[2]);
            texel[3] = 0;
        }
    }
}

static Result paint_batch(HairBatch *batch, const Strands *strands, const Paint *paint,
                          const GpuLimits *limits, Error *error)
{
    size_t count = (size_t)hair_slots(batch) * batch->vertex_count;
    Texel *texels = malloc(count * sizeof *texels);
    if (!texels) return error_set(error, RESULT_FAILED, "no memory for the paint of hair");
    fill(texels, batch, strands, paint);
    gpu_buffer_destroy(&batch->paint);
    Result result =
        gpu_buffer_create(&batch->paint, limits, "hair paint", (int64_t)(count * sizeof *texels),
                          texels, GL_RGBA32UI, error);
    free(texels);
    return result;
}

// The mean colour of all particles.
static void find_mean(const Paint *paint, float mean[3])
{
    double sum[3] = {0};
    for (uint32_t v = 0; v < paint->vertex_count; ++v)
        for (int k = 0; k < 3; ++k) sum[k] += (double)paint->color[v][k];
    for (int k = 0; k < 3; ++k) mean[k] = (float)(sum[k] / paint->vertex_count);
}

Result hair_paint_upload(Hair *hair, const Strands *strands, const Paint *paint,
                         const GpuLimits *limits, Error *error)
{
    Result result = RESULT_OK;
    hair->alike = paint->colors_from_file;
    hair->is_painted = paint->color && paint->vertex_count;
    if (hair->is_painted) find_mean(paint, hair->paint_mean);
    for (uint32_t b = 0; paint->color && b < hair->batch_count && result == RESULT_OK; ++b) {
        assert(hair->batches[b].strand);
        result = paint_batch(&hair->batches[b], strands, paint, limits, error);
    }
    return result;
}
