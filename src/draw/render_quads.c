// SPDX-License-Identifier: MIT
#include "draw/render_quads.h"

#include <math.h>

enum { OIT_LAYERS = 8, OIT_LAYERS_OF_SAMPLES = 16 };

Result render_quads_create(RenderQuads *quads, const Gpu *gpu, const RendererOptions *options,
                           Error *error)
{
    int layers = options->oit == OIT_NONE  ? (options->aov == AOV_DEPTH)
                 : options->oit_layers > 0 ? options->oit_layers
                 : options->samples > 1    ? OIT_LAYERS_OF_SAMPLES
                                           : OIT_LAYERS;
    bool nearest = options->aov > AOV_COVERAGE;
    *quads = (RenderQuads){.limits = &gpu->limits,
                           .width = options->width,
                           .height = options->height,
                           .samples = options->samples,
                           .skips = true};
    Result result = render_hair_create(&quads->hair, nearest, error);
    if (result == RESULT_OK)
        result =
            render_abuffer_create(&quads->abuffer, &gpu->limits, options->width, options->samples,
                                  layers, picture_display(options), options->aov == AOV_DEPTH,
                                  gpu->software, options->pool_bytes, error);
    if (result == RESULT_OK)
        quads->band_rows = render_abuffer_most_rows(&quads->abuffer, options->height);
    return result;
}

void render_quads_destroy(RenderQuads *quads)
{
    render_hair_destroy(&quads->hair);
    render_abuffer_destroy(&quads->abuffer);
    render_cull_destroy(&quads->cull);
    *quads = (RenderQuads){0};
}

Result render_quads_add_base(RenderQuads *quads, Error *error)
{
    return render_abuffer_add_base(&quads->abuffer, error);
}

// The band's lists; measured, but not resolved yet.
static Result draw_band(RenderQuads *quads, Picture *picture, const RenderTarget *target, int row,
                        int rows, GpuTimer *timer, Error *error)
{
    Result result = render_abuffer_begin(&quads->abuffer, rows, picture->base_box, error);
    DrawParams *draw = &picture->draw;
    int samples = quads->samples;
    draw->band[1] = (uint32_t)(row * samples);
    draw->band[2] = (uint32_t)((row + rows) * samples);
    draw->band[3] = (uint32_t)render_abuffer_shard_nodes(&quads->abuffer);
    draw->shards = (uint32_t)quads->abuffer.shards;
    picture_upload(picture);
    quads->cull.outside = quads->cull.hidden = 0; // the same in every band
    glBindFramebuffer(GL_FRAMEBUFFER, target->hair_frame);
    glViewport(0, 0, quads->width * samples, quads->height * samples);
    glScissor(0, row * samples, quads->width * samples, rows * samples);
    for (uint32_t i = 0; i < picture->item_count; ++i) {
        const Hair *hair = picture->items[i].hair;
        for (uint32_t b = 0; b < hair->batch_count && result == RESULT_OK; ++b)
            result = render_hair_draw(&quads->hair, &hair->batches[b], &picture->looks[i],
                                      &quads->cull, quads->limits, timer, error);
    }
    return result;
}

// Rows that fill the pool well if hair is as dense in them as in a band of `rows` with this use:
// some room is left, since a band that does not fit is drawn again. Not many more than before,
// lest one sparse band speaks for all the rest.
static int rows_that_fit(const RenderQuads *quads, const ABufferUse *use, int rows)
{
    double capacity = render_abuffer_shard_nodes(&quads->abuffer);
    double share = fmin(0.85 * capacity / fmax(use->fullest, 1), 1.5);
    int most = render_abuffer_most_rows(&quads->abuffer, quads->height);
    return (int)fmax(1, fmin(rows * share, most));
}

// After a band that did not fit: a larger pool or, where there can be none, fewer rows.
static Result make_it_fit(RenderQuads *quads, const ABufferUse *use, int *rows, Error *error)
{
    bool grown;
    Result result = render_abuffer_grow(&quads->abuffer, use, &grown, error);
    if (result != RESULT_OK || grown) return result;
    if (*rows == 1)
        return error_set(error, RESULT_FAILED,
                         "one row of the picture has %llu hair fragments, more than an A-buffer of "
                         "%lld bytes holds",
                         (unsigned long long)use->fragments, (long long)quads->abuffer.nodes.size);
    *rows = rows_that_fit(quads, use, *rows);
    return RESULT_OK;
}

static void count_band(const ABufferUse *use, RendererCounts *counts)
{
    counts->fragments += use->fragments;
    counts->segments += use->segments;
    counts->culled += use->culled;
    ++counts->bands;
}

static Result draw_bands(RenderQuads *quads, Picture *picture, const RenderTarget *target,
                         bool over_mesh, GpuTimer *timer, RendererCounts *counts, Error *error)
{
    int rows = quads->band_rows;
    for (int row = 0; row < quads->height;) {
        ABufferUse use;
        if (rows > quads->height - row) rows = quads->height - row;
        Result result = draw_band(quads, picture, target, row, rows, timer, error);
        if (result != RESULT_OK) return result;
        render_abuffer_measure(&quads->abuffer, &use);
        if (render_abuffer_holds(&quads->abuffer, &use)) {
            gpu_timer_begin(timer, "draw_resolve");
            glViewport(0, 0, quads->width, quads->height);
            glScissor(0, row, quads->width, rows);
            render_abuffer_resolve(&quads->abuffer, target, over_mesh);
            gpu_timer_end(timer);
            count_band(&use, counts);
            row += rows;
            rows = rows_that_fit(quads, &use, rows);
            continue;
        }
        ++counts->redraws;
        result = make_it_fit(quads, &use, &rows, error);
        if (result != RESULT_OK) return result;
        if (row == 0) quads->band_rows = rows;
    }
    return RESULT_OK;
}

static void count_left_out(RenderQuads *quads, const Picture *picture, RendererCounts *counts)
{
    uint64_t strands = 0;
    for (uint32_t i = 0; i < picture->item_count; ++i)
        for (uint32_t b = 0; b < picture->items[i].hair->batch_count; ++b)
            strands += look_material(&picture->looks[i], &picture->items[i].hair->batches[b])
                           .drawn_strands;
    counts->culled += quads->cull.outside;
    counts->hidden = quads->cull.hidden;
    quads->skips = counts->culled + counts->hidden > strands / RENDER_CULL_SHARE;
}

Result render_quads_draw(RenderQuads *quads, Picture *picture, RenderTarget *target,
                         const CullBase *base, GpuTimer *timer, Image *image,
                         RendererCounts *counts, Error *error)
{
    Result result = render_cull_begin(&quads->cull, quads->limits, base, quads->skips, error);
    if (result != RESULT_OK) return result;
    glEnable(GL_SCISSOR_TEST);
    result = draw_bands(quads, picture, target, base->target != NULL, timer, counts, error);
    glDisable(GL_SCISSOR_TEST);
    if (result != RESULT_OK) return result;
    count_left_out(quads, picture, counts);
    gpu_timer_begin(timer, "draw_read");
    render_target_read(target, image);
    bool short_of_turns = render_abuffer_fell_short(&quads->abuffer);
    gpu_timer_end(timer);
    if (short_of_turns)
        return error_set(error, RESULT_FAILED,
                         "a pixel has more than %d hair fragments, more than this driver's loops "
                         "can visit",
                         ABUFFER_MOST_TURNS);
    counts->pool_bytes = (uint64_t)quads->abuffer.nodes.size;
    return RESULT_OK;
}
