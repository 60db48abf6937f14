// SPDX-License-Identifier: MIT
#include "passes/compute.h"

#include "gpu/gpu_dispatch.h"
#include "gpu/shader.h"

#include "glsl/draw/draw.h"

// llvmpipe silently ends loops after 65,535 iterations in all. For a tile with n ribbons, a lane
// that sorts makes n iterations for runs of 64, and n / 64 times 8, 9, ... iterations for each
// merge of two runs: 57,000 for n = 20,000. Compositing makes fewer; binning makes one for each
// tile of a ribbon.
enum { LONGEST_ON_CPU = 20000, TILES_ON_CPU = 60000 };

static Result build(Compute *compute, int over_base, Error *error)
{
    const GpuSizes *sizes = &compute->bins.limits->sizes;
    ShaderDefine defines[] = {{"GROUP_SIZE", TILE_SIDE * TILE_SIDE / sizes->pixels},
                              {"PIXELS", sizes->pixels},
                              {"STAGED", sizes->stages},
                              {"BASE", over_base},
                              {"NEAREST", compute->nearest},
                              {"RIMS", over_base && !compute->nearest},
                              {"DEPTH", compute->shows_depth},
                              {"SAMPLES", compute->samples},
                              {"KIND", (int)compute->kind},
                              {"TONE", compute->tone},
                              {NULL, 0}};
    TRY(shader_build_compute(&compute->composite[over_base], "draw/compute_composite.comp", defines,
                             error));
    defines[0].value = sizes->items;
    return shader_build_compute(&compute->behind[over_base], "draw/compute_behind.comp", defines,
                                error);
}

Result compute_create(Compute *compute, const Gpu *gpu, const RendererOptions *options,
                      Error *error)
{
    *compute = (Compute){.samples = options->samples,
                         .tone = drawing_display(options),
                         .shows_depth = options->aov == AOV_DEPTH,
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
    compute->band_rows = gpu->software ? TILES_ON_CPU / bins->columns : bins->rows;
    return RESULT_OK;
}

void compute_destroy(Compute *compute)
{
    for (int i = 0; i < 2; ++i) {
        shader_release(compute->composite[i]);
        shader_release(compute->behind[i]);
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

static void use_program(GLuint program, const Compute *compute, const RibbonsBase *base)
{
    const int *box = base->box;
    glUseProgram(program);
    glUniform1i(0, compute->bins.columns);
    if (base->cull.target) glUniform4i(2, box[0], box[1], box[2] + 1, box[3] + 1);
}

static void composite(const Compute *compute, const RenderTarget *target, const RibbonsBase *base,
                      int first, int end)
{
    static const GLenum formats[] = {GL_RGBA8, GL_RGBA16, GL_RGBA32F};
    bool over_base = base->cull.target != NULL;
    int side = TILE_SIDE / target->samples, top = first * side,
        bottom = end * side < target->height ? end * side : target->height;
    if (over_base) {
        bind_texture(BIND_BASE, target->base);
        bind_texture(BIND_MESH_DEPTH, target->depth);
        bind_texture(BIND_RIM, target->rim);
        bind_texture(BIND_RIM_DEPTH, target->rim_depth);
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

static void draw_band(Compute *compute, const Ribbons *ribbons, const RenderTarget *target,
                      int first, int end, GpuTimer *timer)
{
    gpu_timer_begin(timer, "draw_bin");
    compute_bins_fill(&compute->bins, &ribbons->records, &ribbons->keys, (int64_t)ribbons->slots,
                      first, end);
    gpu_timer_end(timer);
    gpu_timer_begin(timer, "draw_sort");
    compute_bins_sort(&compute->bins);
    gpu_timer_end(timer);
    gpu_timer_begin(timer, "draw_composite");
    composite(compute, target, &ribbons->base, first, end);
    gpu_timer_end(timer);
}

// After a band whose lists were too short: grows the lists or, if the driver does not allow that,
// halves the number of rows.
static Result make_it_fit(Compute *compute, const ComputeUse *use, int *rows, Error *error)
{
    bool grown;
    TRY(compute_bins_grow(&compute->bins, use->pairs, &grown, error));
    if (!grown && *rows == 1)
        return error_set(error, RESULT_FAILED,
                         "a row of tiles has %llu ribbons, more than fit into lists of %lld bytes: "
                         "expected fewer, or --raster blocks, which has no limit",
                         (unsigned long long)use->pairs, (long long)compute->bins.pairs.size);
    if (!grown) *rows /= 2;
    return RESULT_OK;
}

// Checks a drawn band. If its lists were long enough, goes to the next band; if not, prepares
// another attempt. See compute_draw.
static Result judge_band(Compute *compute, const ComputeUse *use, int *row, int *rows,
                         ComputeCounts *counts, Error *error)
{
    if (use->longest > (uint32_t)compute->longest)
        return error_set(error, RESULT_FAILED,
                         "%u ribbons touch one tile of 16x16 pixels: expected at most %d, the "
                         "limit of this driver's loops, or --raster blocks, which has no limit",
                         use->longest, compute->longest);
    if (use->pairs <= (uint64_t)compute->bins.room) {
        counts->pairs += use->pairs;
        ++counts->bands;
        *row += *rows;
        *rows = compute->band_rows;
        return RESULT_OK;
    }
    ++counts->redraws;
    TRY(make_it_fit(compute, use, rows, error));
    if (*row == 0) compute->band_rows = *rows;
    return RESULT_OK;
}

Result compute_draw(Compute *compute, const Ribbons *ribbons, const RenderTarget *target,
                    GpuTimer *timer, ComputeCounts *counts, Error *error)
{
    int all = compute->bins.rows, rows = compute->band_rows;
    for (int row = 0; row < all;) {
        ComputeUse use;
        if (rows > all - row) rows = all - row;
        draw_band(compute, ribbons, target, row, row + rows, timer);
        TRY(compute_bins_measure(&compute->bins, &use, error));
        TRY(judge_band(compute, &use, &row, &rows, counts, error));
    }
    return RESULT_OK;
}

// --- An image in one band, whose lists are expected to be long enough. They are checked later.

enum { USE_AT = BLOCK_COUNT_WORDS, TALLY_AT = USE_AT + TILE_USE_WORDS, LATE_BYTES = 4 * TALLY_AT };

bool compute_trusts(const Compute *compute)
{
    return compute->band_rows >= compute->bins.rows;
}

Result compute_begin(Compute *compute, const Ribbons *ribbons, const RenderTarget *target,
                     GpuTimer *timer, Error *error)
{
    LateRead *late = &compute->late;
    draw_band(compute, ribbons, target, 0, compute->bins.rows, timer);
    TRY(late_read_begin(late, "hair's counts", LATE_BYTES + CULL_TALLY_BYTES, error));
    late_read_buffer(late, 0, &ribbons->counts, 4 * BLOCK_COUNT_WORDS);
    late_read_buffer(late, 4 * USE_AT, &compute->bins.use, 4 * TILE_USE_WORDS);
    if (ribbons->cull.tries)
        late_read_buffer(late, 4 * TALLY_AT, &ribbons->cull.tally, CULL_TALLY_BYTES);
    late_read_send(late);
    compute->unsettled = true;
    return RESULT_OK;
}

Result compute_settle(Compute *compute, Ribbons *ribbons, ComputeCounts *counts, bool *good,
                      Error *error)
{
    const void *bytes;
    int row = 0, rows = compute->bins.rows;
    compute->unsettled = false;
    TRY(late_read_open(&compute->late, "hair's counts", &bytes, error));
    const uint32_t *words = bytes;
    ribbons_take_counts(ribbons, words, ribbons->cull.tries ? words + TALLY_AT : NULL);
    ComputeUse use = compute_bins_use(words + USE_AT);
    late_read_close(&compute->late);
    TRY(judge_band(compute, &use, &row, &rows, counts, error));
    *good = row > 0;
    return RESULT_OK;
}
