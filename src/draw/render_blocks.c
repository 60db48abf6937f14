// SPDX-License-Identifier: MIT
#include "draw/render_blocks.h"

#include "glsl/draw/draw.h"

#include <string.h>

enum {
    PROJECT_GROUP = 8,
    ALIGNED_RIBBONS = 32 // at whose multiples every driver lets a buffer's range begin
};

_Static_assert(sizeof(RibbonRecord) == RIBBON_TEXELS * 16, "a record as shaders write it");

static int64_t smaller(int64_t a, int64_t b)
{
    return a < b ? a : b;
}

// Makes room for so many bytes; the driver shows shaders parts of them.
static Result make_room(GpuBuffer *buffer, const GpuLimits *limits, const char *what, int64_t size,
                        Error *error)
{
    if (buffer->size >= size) return RESULT_OK;
    gpu_buffer_destroy(buffer);
    return gpu_buffer_create_pieces(buffer, limits, what, size, 0, error);
}

static void clear(const GpuBuffer *buffer, int64_t size)
{
    const GLuint zero = 0;
    glBindBuffer(GL_SHADER_STORAGE_BUFFER, buffer->buffer);
    glClearBufferSubData(GL_SHADER_STORAGE_BUFFER, GL_R32UI, 0, (GLsizeiptr)size, GL_RED_INTEGER,
                         GL_UNSIGNED_INT, &zero);
}

// Maps the first `size` bytes to be read; NULL on failure.
static const void *map(const GpuBuffer *buffer, int64_t size)
{
    glBindBuffer(GL_SHADER_STORAGE_BUFFER, buffer->buffer);
    return glMapBufferRange(GL_SHADER_STORAGE_BUFFER, 0, (GLsizeiptr)size, GL_MAP_READ_BIT);
}

static void unmap(const GpuBuffer *buffer)
{
    glBindBuffer(GL_SHADER_STORAGE_BUFFER, buffer->buffer);
    glUnmapBuffer(GL_SHADER_STORAGE_BUFFER);
}

Result render_blocks_create(RenderBlocks *blocks, const GpuLimits *limits,
                            const RendererOptions *options, Error *error)
{
    *blocks = (RenderBlocks){
        .project = {.file = "draw/block_project.comp", .group_size = PROJECT_GROUP},
        .limits = limits,
        .skips = true,
        .nearest = options->aov > AOV_COVERAGE,
        .style = {.samples = options->samples,
                  .tone = picture_display(options),
                  .shows_depth = options->aov == AOV_DEPTH,
                  .depth_range = {options->depth_range[0], options->depth_range[1]}}};
    picture_background(options, blocks->style.background);
    Result result = block_raster_create(&blocks->raster, options->width * options->samples,
                                        options->height * options->samples, error);
    if (result == RESULT_OK)
        result = gpu_buffer_create(&blocks->counts, limits, "counts", BLOCK_COUNT_WORDS * 4, NULL,
                                   0, error);
    if (result != RESULT_OK) render_blocks_destroy(blocks);
    return result;
}

void render_blocks_destroy(RenderBlocks *blocks)
{
    GpuBuffer *const buffers[] = {&blocks->ribbons, &blocks->keys, &blocks->counts,
                                  &blocks->material};
    look_programs_destroy(&blocks->project);
    render_cull_destroy(&blocks->cull);
    for (size_t i = 0; i < sizeof buffers / sizeof *buffers; ++i) gpu_buffer_destroy(buffers[i]);
    block_raster_destroy(&blocks->raster);
    render_behind_destroy(&blocks->behind);
    *blocks = (RenderBlocks){0};
}

Result render_blocks_begin(RenderBlocks *blocks, uint64_t segments, const BlocksBase *base,
                           Error *error)
{
    if (segments >= UINT32_MAX)
        return error_set(error, RESULT_FAILED,
                         "%llu segments of hair: at most %u can be drawn at once",
                         (unsigned long long)segments, UINT32_MAX - 1);
    int64_t count = (int64_t)segments + 1;
    const GpuLimits *limits = blocks->limits;
    Result result = make_room(&blocks->ribbons, limits, "ribbons",
                              count * (int64_t)sizeof(RibbonRecord), error);
    if (result == RESULT_OK)
        result =
            make_room(&blocks->keys, limits, "depths", count * (int64_t)sizeof(RibbonKey), error);
    if (result == RESULT_OK)
        result = render_cull_begin(&blocks->cull, limits, &base->cull, blocks->skips, error);
    if (result != RESULT_OK) return result;
    clear(&blocks->keys, count * (int64_t)sizeof(RibbonKey));
    clear(&blocks->counts, blocks->counts.size);
    blocks->base = *base;
    blocks->slots = 0;
    blocks->strands = 0;
    blocks->touched = 0;
    return RESULT_OK;
}

static void bind_range(const GpuBuffer *buffer, GLuint binding, int64_t begin, int64_t end,
                       size_t size)
{
    glBindBufferRange(GL_SHADER_STORAGE_BUFFER, binding, buffer->buffer,
                      (GLintptr)(begin * (int64_t)size),
                      (GLsizeiptr)((end - begin) * (int64_t)size));
}

// Projects part.drawn_strands strands from part.first_strand on, whose ribbons a shader can see at
// once.
static Result project_part(RenderBlocks *blocks, const HairBatch *batch, const Look *look,
                           const MaterialParams *part, int64_t slots, Error *error)
{
    int64_t first = (int64_t)blocks->slots, begin = first / ALIGNED_RIBBONS * ALIGNED_RIBBONS;
    uint32_t count = part->drawn_strands;
    gpu_buffer_set_uniforms(&blocks->material, BIND_MATERIAL, part, sizeof *part);
    Result result = RESULT_OK;
    if (blocks->cull.tries) result = render_cull_list(&blocks->cull, batch, part, &count, error);
    if (result == RESULT_OK) result = look_programs_use(&blocks->project, look, batch, error);
    if (result != RESULT_OK) return result;
    bind_range(&blocks->ribbons, BIND_RIBBONS_OUT, begin, first + slots, sizeof(RibbonRecord));
    bind_range(&blocks->keys, BIND_KEYS_OUT, begin, first + slots, sizeof(RibbonKey));
    glUniform1i(0, (GLint)(first - begin));
    glUniform2i(1, (GLint)count, blocks->cull.tries);
    if (count) glDispatchCompute((count + PROJECT_GROUP - 1) / PROJECT_GROUP, 1, 1);
    blocks->slots += (size_t)slots;
    blocks->strands += part->drawn_strands;
    return RESULT_OK;
}

Result render_blocks_add(RenderBlocks *blocks, const HairBatch *batch, const Look *look,
                         Error *error)
{
    MaterialParams part = look_material(look, batch);
    Result result = render_cull_make_room(&blocks->cull, blocks->limits, part.drawn_strands, error);
    if (result != RESULT_OK) return result;
    int64_t of_strand = (int64_t)(batch->vertex_count - 1) * part.smooth_parts,
            most =
                (blocks->limits->storage_block / (int64_t)sizeof(RibbonRecord) - ALIGNED_RIBBONS) /
                of_strand;
    uint strands = part.drawn_strands;
    gpu_buffer_bind_texture(&batch->position, BIND_POSITION);
    gpu_buffer_bind_texture(&batch->strand_id, BIND_STRAND_ID);
    gpu_buffer_bind_storage(&blocks->counts, BIND_BLOCK_COUNTS_OUT);
    for (uint first = 0; first < strands && result == RESULT_OK; first += part.drawn_strands) {
        part.first_strand = first;
        part.drawn_strands = (uint)smaller(strands - first, most);
        result = project_part(blocks, batch, look, &part, part.drawn_strands * of_strand, error);
    }
    return result;
}

static Result read_counts(RenderBlocks *blocks, Error *error)
{
    const GLuint *counts = map(&blocks->counts, blocks->counts.size);
    if (!counts) return error_set(error, RESULT_FAILED, "hair's counts cannot be read");
    blocks->segments = blocks->culled = 0;
    for (int i = 0; i < BLOCK_COUNT_WORDS; i += 16) {
        blocks->segments += counts[i];
        blocks->culled += counts[i + 1];
    }
    unmap(&blocks->counts);
    blocks->culled += blocks->cull.outside;
    blocks->skips = blocks->culled + blocks->cull.hidden > blocks->strands / RENDER_CULL_SHARE;
    return RESULT_OK;
}

static Result draw_mapped(RenderBlocks *blocks, BlockPicture *picture, GpuTimer *timer,
                          Error *error)
{
    picture->keys = map(&blocks->keys, blocks->keys.size);
    picture->records = map(&blocks->ribbons, blocks->ribbons.size);
    Result result = picture->keys && picture->records
                        ? RESULT_OK
                        : error_set(error, RESULT_FAILED, "hair's ribbons cannot be read");
    gpu_timer_begin(timer, "draw_bin");
    if (result == RESULT_OK)
        result = block_raster_deal(&blocks->raster, picture, &blocks->touched, error);
    gpu_timer_end(timer);
    gpu_timer_begin(timer, "draw_composite");
    if (result == RESULT_OK) block_raster_composite(&blocks->raster, picture);
    gpu_timer_end(timer);
    if (picture->keys) unmap(&blocks->keys);
    if (picture->records) unmap(&blocks->ribbons);
    return result;
}

static Result read_behind(RenderBlocks *blocks, BlockPicture *picture, GpuTimer *timer,
                          Error *error)
{
    const BlocksBase *base = &blocks->base;
    if (!base->cull.target) return RESULT_OK;
    memcpy(picture->style.depth, base->depth, sizeof picture->style.depth);
    gpu_timer_begin(timer, "draw_read");
    Result result =
        render_behind_read(&blocks->behind, base->cull.target, base->box, base->version, error);
    gpu_timer_end(timer);
    picture->base = &blocks->behind.base;
    return result;
}

Result render_blocks_draw(RenderBlocks *blocks, GpuTimer *timer, Image *image, Error *error)
{
    BlockPicture picture = {
        .slots = blocks->slots, .style = blocks->style, .nearest = blocks->nearest, .image = image};
    glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
    Result result = read_counts(blocks, error);
    if (result == RESULT_OK) result = read_behind(blocks, &picture, timer, error);
    return result == RESULT_OK ? draw_mapped(blocks, &picture, timer, error) : result;
}
