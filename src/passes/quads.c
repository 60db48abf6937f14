// SPDX-License-Identifier: MIT
#include "passes/quads.h"

#include "gpu/gpu_dispatch.h"
#include "gpu/gpu_uniforms.h"

#include "glsl/draw/draw.h"

#include <math.h>

// --- Ribbons to lists of fragments.

// Number of particles that are projected at a time, to keep the buffers small.
enum { PART_PARTICLES = 1 << 19 };

static void destroy_ribbons(QuadRibbons *hair)
{
    look_programs_destroy(&hair->project);
    shader_release(hair->draw);
    if (hair->vertex_array) glDeleteVertexArrays(1, &hair->vertex_array);
    gpu_buffer_destroy(&hair->edges);
    gpu_buffer_destroy(&hair->shades);
    gpu_buffer_destroy(&hair->indices);
    gpu_buffer_destroy(&hair->command);
    *hair = (QuadRibbons){0};
}

// `nearest`: opaque ribbons, for images without blending: a ribbon hides everything behind it in
// each pixel that it covers partly.
static Result create_ribbons(QuadRibbons *hair, const GpuLimits *limits, bool nearest, Error *error)
{
    const ShaderDefine defines[] = {{"NEAREST", nearest}, {NULL, 0}};
    *hair = (QuadRibbons){
        .project = {.file = "draw/hair_project.comp", .group_size = limits->sizes.strands}};
    glGenVertexArrays(1, &hair->vertex_array);
    Result result =
        shader_build_draw(&hair->draw, "draw/hair.vert", "draw/hair.frag", defines, error);
    if (result != RESULT_OK) destroy_ribbons(hair);
    return result;
}

static Result make_scratch(QuadRibbons *hair, uint32_t strands, uint32_t vertex_count,
                           const GpuLimits *limits, Error *error)
{
    int64_t particles = (int64_t)strands * vertex_count, segments = particles - strands;
    TRY(gpu_buffer_reserve(&hair->edges, limits, "hair edges", particles * 16, GL_RGBA32UI, error));
    TRY(gpu_buffer_reserve(&hair->shades, limits, "hair shades", particles * 16, GL_RGBA32UI,
                           error));
    TRY(gpu_buffer_reserve(&hair->indices, limits, "hair triangles", segments * 24, 0, error));
    return gpu_buffer_reserve(&hair->command, limits, "draw command", COMMAND_WORDS * 4, 0, error);
}

static Result project(QuadRibbons *hair, const GpuLimits *limits, const HairBatch *batch,
                      const Look *look, Cull *cull, Error *error)
{
    const MaterialParams *material = &look->material;
    const GLuint command[COMMAND_WORDS] = {[COMMAND_INSTANCE_COUNT] = 1};
    gpu_uniforms_set(BIND_MATERIAL, material, sizeof *material);
    gpu_buffer_bind_texture(&batch->position, BIND_POSITION);
    Result result = RESULT_OK;
    if (cull->tries) result = cull_list(cull, batch, material, error);
    THEN(result, look_programs_use(&hair->project, look, batch, error));
    if (result != RESULT_OK) return result;
    glUniform2i(0, (GLint)material->drawn_strands, cull->tries);
    gpu_buffer_write(&hair->command, 0, command, sizeof command);
    gpu_buffer_bind_texture(&batch->strand_id, BIND_STRAND_ID);
    gpu_buffer_bind_storage(&hair->edges, BIND_EDGES_OUT);
    gpu_buffer_bind_storage(&hair->shades, BIND_SHADES_OUT);
    gpu_buffer_bind_storage(&hair->indices, BIND_INDICES_OUT);
    gpu_buffer_bind_storage(&hair->command, BIND_COMMAND_OUT);
    gpu_dispatch(limits, material->drawn_strands, (uint64_t)limits->sizes.strands, 1);
    glMemoryBarrier(GL_TEXTURE_FETCH_BARRIER_BIT | GL_ELEMENT_ARRAY_BARRIER_BIT |
                    GL_COMMAND_BARRIER_BIT);
    return RESULT_OK;
}

static void draw_ribbons(QuadRibbons *hair)
{
    glUseProgram(hair->draw);
    glBindVertexArray(hair->vertex_array);
    gpu_buffer_bind_texture(&hair->edges, BIND_EDGES);
    gpu_buffer_bind_texture(&hair->shades, BIND_SHADES);
    glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, hair->indices.buffer);
    glBindBuffer(GL_DRAW_INDIRECT_BUFFER, hair->command.buffer);
    glDrawElementsIndirect(GL_TRIANGLES, GL_UNSIGNED_INT, NULL);
    // The next part overwrites buffers that the vertex shader of this part reads.
    glMemoryBarrier(GL_TEXTURE_FETCH_BARRIER_BIT | GL_SHADER_STORAGE_BARRIER_BIT |
                    GL_BUFFER_UPDATE_BARRIER_BIT);
}

// Draws one batch to the current framebuffer and A-buffer within the scissor. If `cull` is active,
// culled strands are left out.
static Result draw_batch(QuadRibbons *hair, const HairBatch *batch, const Look *look, Cull *cull,
                         const GpuLimits *limits, GpuTimer *timer, Error *error)
{
    Look part = *look;
    part.material = look_material(look, batch);
    uint32_t n = (batch->vertex_count - 1) * part.material.smooth_parts + 1,
             most = n < PART_PARTICLES ? PART_PARTICLES / n : 1,
             strands = part.material.drawn_strands;
    for (uint32_t first = 0; first < strands; first += most) {
        uint32_t left = strands - first;
        part.material.first_strand = first;
        part.material.drawn_strands = left < most ? left : most;
        Result result = make_scratch(hair, part.material.drawn_strands, n, limits, error);
        THEN(result, cull_make_room(cull, part.material.drawn_strands, error));
        gpu_timer_begin(timer, "draw_project");
        THEN(result, project(hair, limits, batch, &part, cull, error));
        gpu_timer_end(timer);
        if (result != RESULT_OK) return result;
        gpu_timer_begin(timer, "draw_hair");
        draw_ribbons(hair);
        gpu_timer_end(timer);
    }
    return RESULT_OK;
}

// --- Bands of the image.

enum { OIT_LAYERS = 8, OIT_LAYERS_OF_SAMPLES = 16 };

Result quads_create(Quads *quads, const Gpu *gpu, const RendererOptions *options, Error *error)
{
    int layers = options->oit == OIT_NONE  ? (options->aov == AOV_DEPTH)
                 : options->oit_layers > 0 ? options->oit_layers
                 : options->samples > 1    ? OIT_LAYERS_OF_SAMPLES
                                           : OIT_LAYERS;
    bool nearest = options->aov > AOV_COVERAGE;
    *quads = (Quads){.limits = &gpu->limits,
                     .cull = {.limits = &gpu->limits},
                     .width = options->width,
                     .height = options->height,
                     .samples = options->samples,
                     .skips = true};
    TRY(create_ribbons(&quads->hair, &gpu->limits, nearest, error));
    TRY(abuffer_create(&quads->abuffer, &gpu->limits, options->width, options->samples, layers,
                       drawing_display(options), options->aov, gpu->software, options->pool_bytes,
                       error));
    quads->band_rows = abuffer_most_rows(&quads->abuffer, options->height);
    return RESULT_OK;
}

void quads_destroy(Quads *quads)
{
    destroy_ribbons(&quads->hair);
    abuffer_destroy(&quads->abuffer);
    cull_destroy(&quads->cull);
    *quads = (Quads){0};
}

Result quads_add_base(Quads *quads, Error *error)
{
    return abuffer_add_base(&quads->abuffer, error);
}

// Fills the lists of a band and queues the measurement of their length. Does not resolve them.
static Result draw_band(Quads *quads, Drawing *drawing, const RenderTarget *target, int row,
                        int rows, GpuTimer *timer, Error *error)
{
    Result result = abuffer_begin(&quads->abuffer, rows, drawing->base_box, error);
    DrawParams *draw = &drawing->draw;
    int samples = quads->samples;
    draw->band[1] = (uint32_t)(row * samples);
    draw->band[2] = (uint32_t)((row + rows) * samples);
    draw->band[3] = (uint32_t)abuffer_shard_nodes(&quads->abuffer);
    draw->shards = (uint32_t)quads->abuffer.shards;
    drawing_upload(drawing);
    cull_restart(&quads->cull);
    glBindFramebuffer(GL_FRAMEBUFFER, target->hair_frame);
    glViewport(0, 0, quads->width * samples, quads->height * samples);
    glScissor(0, row * samples, quads->width * samples, rows * samples);
    for (uint32_t i = 0; i < drawing->item_count; ++i) {
        const Hair *hair = drawing->items[i].hair;
        for (uint32_t b = 0; b < hair->batch_count && result == RESULT_OK; ++b)
            result = draw_batch(&quads->hair, &hair->batches[b], &drawing->looks[i], &quads->cull,
                                quads->limits, timer, error);
    }
    THEN(result, abuffer_send_use(&quads->abuffer, &quads->cull, error));
    return result;
}

static void resolve_band(const Quads *quads, const RenderTarget *target, bool over_mesh, int row,
                         int rows, GpuTimer *timer)
{
    gpu_timer_begin(timer, "draw_resolve");
    glViewport(0, 0, quads->width, quads->height);
    glScissor(0, row, quads->width, rows);
    abuffer_resolve(&quads->abuffer, target, over_mesh);
    gpu_timer_end(timer);
}

// The number of rows that fill the pool well if hair is as dense in them as it was in a band of
// `rows` with this use. It leaves 15 % of the pool free, because a band that does not fit must be
// drawn again. It grows by at most half, so that one sparse band does not decide for all others.
static int rows_that_fit(const Quads *quads, const ABufferUse *use, int rows)
{
    double capacity = abuffer_shard_nodes(&quads->abuffer);
    double share = fmin(0.85 * capacity / fmax(use->fullest, 1), 1.5);
    int most = abuffer_most_rows(&quads->abuffer, quads->height);
    return (int)fmax(1, fmin(rows * share, most));
}

// After a band that did not fit: grows the pool or, if that is impossible, reduces the number of
// rows.
static Result make_it_fit(Quads *quads, const ABufferUse *use, int *rows, Error *error)
{
    bool grown;
    Result result = abuffer_grow(&quads->abuffer, use, &grown, error);
    if (result != RESULT_OK || grown) return result;
    if (*rows == 1)
        return error_set(
            error, RESULT_FAILED,
            "one row of the image has %llu hair fragments, more than fit into an A-buffer of %lld "
            "bytes: expected fewer, or --raster blocks, which has no limit",
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

static Result draw_bands(Quads *quads, Drawing *drawing, const RenderTarget *target, bool over_mesh,
                         GpuTimer *timer, RendererCounts *counts, Error *error)
{
    int rows = quads->band_rows;
    for (int row = 0; row < quads->height;) {
        ABufferUse use;
        if (rows > quads->height - row) rows = quads->height - row;
        TRY(draw_band(quads, drawing, target, row, rows, timer, error));
        TRY(abuffer_take_use(&quads->abuffer, &use, &quads->cull, error));
        if (abuffer_holds(&quads->abuffer, &use)) {
            resolve_band(quads, target, over_mesh, row, rows, timer);
            count_band(&use, counts);
            row += rows;
            rows = rows_that_fit(quads, &use, rows);
            continue;
        }
        ++counts->redraws;
        TRY(make_it_fit(quads, &use, &rows, error));
        if (row == 0) quads->band_rows = rows;
    }
    return RESULT_OK;
}

static void count_left_out(Quads *quads, const Drawing *drawing, RendererCounts *counts)
{
    uint64_t strands = 0;
    for (uint32_t i = 0; i < drawing->item_count; ++i)
        for (uint32_t b = 0; b < drawing->items[i].hair->batch_count; ++b)
            strands += look_material(&drawing->looks[i], &drawing->items[i].hair->batches[b])
                           .drawn_strands;
    counts->culled += quads->cull.outside;
    counts->hidden = quads->cull.hidden;
    quads->skips = counts->culled + counts->hidden > strands / CULL_SHARE;
}

// Draws in bands; each band is measured before it is resolved.
static Result draw_measured(Quads *quads, Drawing *drawing, RenderTarget *target, bool over_mesh,
                            GpuTimer *timer, RendererCounts *counts, Error *error)
{
    glEnable(GL_SCISSOR_TEST);
    Result result = draw_bands(quads, drawing, target, over_mesh, timer, counts, error);
    glDisable(GL_SCISSOR_TEST);
    if (result == RESULT_OK) count_left_out(quads, drawing, counts);
    return result;
}

// Draws one band that is expected to fit. quads_settle checks that later.
static Result draw_trusting(Quads *quads, Drawing *drawing, const RenderTarget *target,
                            bool over_mesh, GpuTimer *timer, Error *error)
{
    glEnable(GL_SCISSOR_TEST);
    Result result = draw_band(quads, drawing, target, 0, quads->height, timer, error);
    if (result == RESULT_OK) resolve_band(quads, target, over_mesh, 0, quads->height, timer);
    glDisable(GL_SCISSOR_TEST);
    quads->unsettled = result == RESULT_OK;
    return result;
}

static Result send(Quads *quads, RenderTarget *target, bool again, GpuTimer *timer, Error *error)
{
    gpu_timer_begin(timer, "draw_read");
    Result result = render_target_send(target, &quads->abuffer.shortage, again, error);
    gpu_timer_end(timer);
    return result;
}

Result quads_draw(Quads *quads, Drawing *drawing, RenderTarget *target, const CullBase *base,
                  GpuTimer *timer, RendererCounts *counts, Error *error)
{
    bool over_mesh = base->target != NULL, one = quads->band_rows >= quads->height;
    quads->unsettled = false;
    TRY(cull_begin(&quads->cull, base, quads->skips, error));
    TRY(one ? draw_trusting(quads, drawing, target, over_mesh, timer, error)
            : draw_measured(quads, drawing, target, over_mesh, timer, counts, error));
    counts->pool_bytes = (uint64_t)quads->abuffer.nodes.size;
    return send(quads, target, false, timer, error);
}

Result quads_settle(Quads *quads, Drawing *drawing, RenderTarget *target, bool over_mesh,
                    GpuTimer *timer, RendererCounts *counts, Error *error)
{
    ABufferUse use;
    int rows = quads->height;
    if (!quads->unsettled) return RESULT_OK;
    quads->unsettled = false;
    TRY(abuffer_take_use(&quads->abuffer, &use, &quads->cull, error));
    if (abuffer_holds(&quads->abuffer, &use)) {
        count_band(&use, counts);
        count_left_out(quads, drawing, counts);
        return RESULT_OK;
    }
    ++counts->redraws;
    TRY(make_it_fit(quads, &use, &rows, error));
    quads->band_rows = rows;
    TRY(draw_measured(quads, drawing, target, over_mesh, timer, counts, error));
    counts->pool_bytes = (uint64_t)quads->abuffer.nodes.size;
    return send(quads, target, true, timer, error);
}

Result quads_take(RenderTarget *target, int place, Image *image, Error *error)
{
    uint32_t short_of_turns;
    TRY(render_target_take(target, place, image, &short_of_turns, error));
    if (short_of_turns)
        return error_set(error, RESULT_FAILED,
                         "a pixel has more than %d hair fragments, the limit of this driver's "
                         "loops: expected fewer, or --raster blocks, which has no limit",
                         ABUFFER_MOST_TURNS);
    return RESULT_OK;
}
