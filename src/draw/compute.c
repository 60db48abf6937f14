// SPDX-License-Identifier: MIT
#include "draw/compute.h"

#include "gpu/gpu_dispatch.h"
#include "gpu/shader.h"

#include "glsl/draw/draw.h"

// CPU drivers end loops silently after 65,535 turns in all. Sorting and compositing take less than
// two for a ribbon of a tile, binning one for a tile of a ribbon.
enum { LONGEST_ON_CPU = 32000, TILES_ON_CPU = 60000 };

enum { MOST_SLOTS = 1 << 24 };

static Result build(Compute *compute, int over_base, Error *error)
{
    const GpuSizes *sizes = &compute->bins.limits->sizes;
    ShaderDefine defines[] = {{"GROUP_SIZE", TILE_SIDE * TILE_SIDE / sizes->pixels},
                              {"PIXELS", sizes->pixels},
                              {"STAGED", sizes->stages},
                              {"BASE", over_base},
                              {"NEAREST", compute->nearest},
                              {"DEPTH", compute->style.shows_depth},
                              {"SAMPLES", compute->style.samples},
                              {"KIND", (int)compute->kind},
                              {"TONE", compute->style.tone},
                              {NULL, 0}};
    TRY(shader_build_compute(&compute->composite[over_base], "draw/compute_composite.comp", defines,
                             error));
    defines[0].value = sizes->items;
    return shader_build_compute(&compute->behind[over_base], "draw/compute_behind.comp", defines,
                                error);
}

size_t compute_most_slots(const Gpu *gpu)
{
    int64_t shown = gpu->limits.texture_texels / RIBBON_TEXELS - 1;
    if (gpu->kind != GPU_HARDWARE) return BLOCKS_MOST_SLOTS;
    return (size_t)(shown < MOST_SLOTS ? shown : MOST_SLOTS);
}

Result compute_create(Compute *compute, const Gpu *gpu, const RendererOptions *options,
                      Error *error)
{
    *compute = (Compute){.style = {.samples = options->samples,
                                   .tone = drawing_display(options),
                                   .shows_depth = options->aov == AOV_DEPTH},
                         .nearest = options->aov > AOV_COVERAGE,
                         .kind = options->kind,
                         .longest = gpu->software ? LONGEST_ON_CPU : INT32_MAX};
    ComputeBins *bins = &compute->bins;
    Result result =
        compute_bins_create(bins, &gpu->limits, options->width * options->samples,
                            options->height * options->samples, options->pool_bytes, error);
    THEN(result, build(compute, 0, error));
    if (result != RESULT_OK) {
        compute_destroy(compute);
        return result;
    }
    compute->most_rows = gpu->software ? TILES_ON_CPU / bins->columns : bins->rows;
    if (compute->most_rows > bins->rows) compute->most_rows = bins->rows;
    compute->band_rows = compute->most_rows;
    return RESULT_OK;
}

void compute_destroy(Compute *compute)
{
    for (int i = 0; i < 2; ++i) {
        if (compute->composite[i]) glDeleteProgram(compute->composite[i]);
        if (compute->behind[i]) glDeleteProgram(compute->behind[i]);
    }
    compute_bins_destroy(&compute->bins);
    *compute = (Compute){0};
}

Result compute_add_base(Compute *compute, Error *error)
{
    return compute->composite[1] ? RESULT_OK : build(compute, 1, error);
}

static void bind_texture(GLuint unit, GLuint texture)
{
    glActiveTexture(GL_TEXTURE0 + unit);
    glBindTexture(GL_TEXTURE_2D, texture);
}

static void use_program(GLuint program, const Compute *compute, const BlocksBase *base)
{
    const int *box = base->box;
    glUseProgram(program);
    glUniform1i(0, compute->bins.columns);
    if (base->cull.target) glUniform4i(2, box[0], box[1], box[2] + 1, box[3] + 1);
}

static void composite(const Compute *compute, const RenderTarget *target, const BlocksBase *base,
                      int first, int end)
{
    static const GLenum formats[] = {GL_RGBA8, GL_RGBA16, GL_RGBA32F};
    bool over_base = base->cull.target != NULL;
    int side = TILE_SIDE / target->samples, top = first * side,
        bottom = end * side < target->height ? end * side : target->height;
    if (over_base) {
        bind_texture(BIND_BASE, target->base);
        bind_texture(BIND_MESH_DEPTH, target->depth);
    }
    glBindImageTexture(IMAGE_PICTURE, target->image, 0, GL_FALSE, 0, GL_WRITE_ONLY,
                       formats[target->kind]);
    use_program(compute->behind[over_base], compute, base);
    glUniform3i(1, target->width, top, bottom);
    gpu_dispatch(compute->bins.limits, (uint64_t)target->width * (uint64_t)(bottom - top),
                 (uint64_t)compute->bins.limits->sizes.items, 1);
    use_program(compute->composite[over_base], compute, base);
    glUniform1ui(1, (GLuint)compute->bins.room);
    compute_bins_dispatch(&compute->bins);
    glMemoryBarrier(GL_FRAMEBUFFER_BARRIER_BIT | GL_SHADER_STORAGE_BARRIER_BIT |
                    GL_BUFFER_UPDATE_BARRIER_BIT);
}

static void draw_band(Compute *compute, const Blocks *blocks, const RenderTarget *target, int first,
                      int end, GpuTimer *timer)
{
    gpu_timer_begin(timer, "draw_bin");
    compute_bins_fill(&compute->bins, &blocks->ribbons, &blocks->keys, (int64_t)blocks->slots,
                      first, end);
    gpu_timer_end(timer);
    gpu_timer_begin(timer, "draw_sort");
    compute_bins_sort(&compute->bins);
    gpu_timer_end(timer);
    gpu_timer_begin(timer, "draw_composite");
    composite(compute, target, &blocks->base, first, end);
    gpu_timer_end(timer);
}

// After a band that did not fit: more room or, where there can be none, fewer rows.
static Result make_it_fit(Compute *compute, const ComputeUse *use, int *rows, bool *can,
                          Error *error)
{
    bool grown;
    TRY(compute_bins_grow(&compute->bins, use->pairs, &grown, error));
    *can = grown || *rows > 1;
    if (!grown) *rows = *rows > 1 ? *rows / 2 : 1;
    return RESULT_OK;
}

// Draws the image in bands of band_rows, of which each is looked at before the next one, or in one
// that is looked at when the image has been read, when there is nothing left to wait for.
Result compute_draw(Compute *compute, const Blocks *blocks, RenderTarget *target, GpuTimer *timer,
                    Image *image, ComputeCounts *counts, bool *drawn, Error *error)
{
    int all = compute->bins.rows, rows = compute->band_rows;
    *counts = (ComputeCounts){0};
    *drawn = true;
    for (int row = 0; row < all;) {
        ComputeUse use;
        if (rows > all - row) rows = all - row;
        draw_band(compute, blocks, target, row, row + rows, timer);
        bool is_last = row + rows == all;
        gpu_timer_begin(timer, "draw_read");
        Result read = is_last ? render_target_read(target, image, error) : RESULT_OK;
        gpu_timer_end(timer);
        TRY(read);
        TRY(compute_bins_measure(&compute->bins, &use, error));
        *drawn = use.longest <= (uint32_t)compute->longest;
        if (*drawn && use.pairs > (uint64_t)compute->bins.room) {
            ++counts->redraws;
            TRY(make_it_fit(compute, &use, &rows, drawn, error));
            if (row == 0) compute->band_rows = rows;
            if (*drawn) continue;
        }
        if (!*drawn) return RESULT_OK;
        counts->pairs += use.pairs;
        ++counts->bands;
        row += rows;
        rows = compute->band_rows;
    }
    return RESULT_OK;
}
