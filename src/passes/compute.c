// SPDX-License-Identifier: MIT
#include "passes/compute.h"

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
    late_read_destroy(&compute->late);
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

// One band, and after it `use`: whether it fits, or what comes next. See compute_draw.
static Result judge_band(Compute *compute, const ComputeUse *use, int *row, int *rows,
                         ComputeCounts *counts, bool *drawn, Error *error)
{
    *drawn = use->longest <= (uint32_t)compute->longest;
    if (!*drawn) return RESULT_OK;
    if (use->pairs <= (uint64_t)compute->bins.room) {
        counts->pairs += use->pairs;
        ++counts->bands;
        *row += *rows;
        *rows = compute->band_rows;
        return RESULT_OK;
    }
    ++counts->redraws;
    TRY(make_it_fit(compute, use, rows, drawn, error));
    if (*row == 0) compute->band_rows = *rows;
    return RESULT_OK;
}

Result compute_draw(Compute *compute, const Blocks *blocks, const RenderTarget *target,
                    GpuTimer *timer, ComputeCounts *counts, bool *drawn, Error *error)
{
    int all = compute->bins.rows, rows = compute->band_rows;
    *drawn = true;
    for (int row = 0; row < all && *drawn;) {
        ComputeUse use;
        if (rows > all - row) rows = all - row;
        draw_band(compute, blocks, target, row, row + rows, timer);
        TRY(compute_bins_measure(&compute->bins, &use, error));
        TRY(judge_band(compute, &use, &row, &rows, counts, drawn, error));
    }
    return RESULT_OK;
}

// --- An image that is trusted to fit.

enum { USE_AT = BLOCK_COUNT_WORDS, TALLY_AT = USE_AT + TILE_USE_WORDS, LATE_BYTES = 4 * TALLY_AT };

bool compute_trusts(const Compute *compute)
{
    return compute->band_rows >= compute->bins.rows;
}

Result compute_begin(Compute *compute, const Blocks *blocks, const RenderTarget *target,
                     GpuTimer *timer, Error *error)
{
    LateRead *late = &compute->late;
    draw_band(compute, blocks, target, 0, compute->bins.rows, timer);
    TRY(late_read_begin(late, "hair's counts", LATE_BYTES + CULL_TALLY_BYTES, error));
    late_read_buffer(late, 0, &blocks->counts, 4 * BLOCK_COUNT_WORDS);
    late_read_buffer(late, 4 * USE_AT, &compute->bins.use, 4 * TILE_USE_WORDS);
    if (blocks->cull.tries)
        late_read_buffer(late, 4 * TALLY_AT, &blocks->cull.tally, CULL_TALLY_BYTES);
    late_read_send(late);
    compute->unsettled = true;
    return RESULT_OK;
}

Result compute_settle(Compute *compute, Blocks *blocks, ComputeCounts *counts, bool *good,
                      bool *drawn, Error *error)
{
    const void *bytes;
    int row = 0, rows = compute->bins.rows;
    compute->unsettled = false;
    TRY(late_read_open(&compute->late, "hair's counts", &bytes, error));
    const uint32_t *words = bytes;
    blocks_take_counts(blocks, words, blocks->cull.tries ? words + TALLY_AT : NULL);
    ComputeUse use = compute_bins_use(words + USE_AT);
    late_read_close(&compute->late);
    TRY(judge_band(compute, &use, &row, &rows, counts, drawn, error));
    *good = row > 0;
    return RESULT_OK;
}
