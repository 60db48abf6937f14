// SPDX-License-Identifier: MIT
#include "draw/blocks.h"

#include "gpu/gpu_dispatch.h"
#include "gpu/gpu_uniforms.h"

#include "glsl/draw/draw.h"

#include <stdlib.h>
#include <string.h>

// --- Mesh and floor, read back.

static int clamp(int x, int most)
{
    return x < 0 ? 0 : x > most ? most : x;
}

static void destroy_behind(BlocksBehind *behind)
{
    free(behind->light);
    free(behind->depth);
    *behind = (BlocksBehind){0};
}

// The part of the box that lies in the image.
static BlockBase find_part(const RenderTarget *target, const int box[4])
{
    int width = target->width * target->samples, height = target->height * target->samples,
        x = clamp(box[0], width), y = clamp(box[1], height),
        right = clamp(box[2] < width ? box[2] + 1 : width, width),
        bottom = clamp(box[3] < height ? box[3] + 1 : height, height);
    return (BlockBase){
        .x = x, .y = y, .width = right > x ? right - x : 0, .height = bottom > y ? bottom - y : 0};
}

static Result make_room_behind(BlocksBehind *behind, size_t count, Error *error)
{
    if (behind->room >= count) return RESULT_OK;
    destroy_behind(behind);
    behind->light = malloc(count * sizeof *behind->light);
    behind->depth = malloc(count * sizeof *behind->depth);
    if (behind->light && behind->depth) {
        behind->room = count;
        return RESULT_OK;
    }
    destroy_behind(behind);
    return error_set(error, RESULT_FAILED, "no memory to read %zu px of mesh and floor", count);
}

static Result read_back(BlocksBehind *behind, const RenderTarget *target, const int box[4],
                        uint64_t version, Error *error)
{
    if (behind->version == version) return RESULT_OK;
    BlockBase part = find_part(target, box);
    TRY(make_room_behind(behind, (size_t)part.width * (size_t)part.height, error));
    part.light = (const uint16_t(*)[4])(void *)behind->light;
    part.depth = behind->depth;
    glBindFramebuffer(GL_READ_FRAMEBUFFER, target->base_frame);
    glReadPixels(part.x, part.y, part.width, part.height, GL_RGBA, GL_HALF_FLOAT, behind->light);
    glReadPixels(part.x, part.y, part.width, part.height, GL_DEPTH_COMPONENT, GL_FLOAT,
                 behind->depth);
    behind->base = part;
    Result result = gpu_check("reading mesh and floor back", error);
    behind->version = result == RESULT_OK ? version : 0;
    return result;
}

// --- Blocks.

enum {
    ALIGNED_RIBBONS = 32,  // at whose multiples every driver lets a buffer's range begin
    STORED_SLOTS = 1 << 18 // 19 MB; a strand takes 65,000 at most
};

static const char UNREADABLE[] = "hair's ribbons cannot be read";

_Static_assert(sizeof(RibbonRecord) == RIBBON_TEXELS * 16, "a record as shaders write it");

static int64_t smaller(int64_t a, int64_t b)
{
    return a < b ? a : b;
}

// Makes room for so many bytes; the driver shows shaders parts of them.
static Result make_room(GpuBuffer *buffer, const GpuLimits *limits, const char *what, int64_t size,
                        GLenum texel_format, Error *error)
{
    if (buffer->size >= size) return RESULT_OK;
    gpu_buffer_destroy(buffer);
    return gpu_buffer_create_pieces(buffer, limits, what, size, texel_format, error);
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

Result blocks_create(Blocks *blocks, const GpuLimits *limits, const RendererOptions *options,
                     Error *error)
{
    *blocks = (Blocks){
        .project = {.file = "draw/block_project.comp", .group_size = limits->sizes.strands},
        .most_slots = BLOCKS_MOST_SLOTS,
        .stored_slots = STORED_SLOTS,
        .limits = limits,
        .cull = {.limits = limits},
        .skips = true,
        .nearest = options->aov > AOV_COVERAGE,
        .style = {.samples = options->samples,
                  .tone = drawing_display(options),
                  .shows_depth = options->aov == AOV_DEPTH,
                  .depth_range = {options->depth_range[0], options->depth_range[1]}}};
    drawing_background(options, blocks->style.background);
    Result result = block_raster_create(&blocks->raster, options->width * options->samples,
                                        options->height * options->samples, error);
    THEN(result, gpu_buffer_create(&blocks->counts, limits, "counts", BLOCK_COUNT_WORDS * 4, NULL,
                                   0, error));
    if (result != RESULT_OK) blocks_destroy(blocks);
    return result;
}

void blocks_destroy(Blocks *blocks)
{
    GpuBuffer *const buffers[] = {&blocks->ribbons, &blocks->keys, &blocks->counts};
    look_programs_destroy(&blocks->project);
    cull_destroy(&blocks->cull);
    for (size_t i = 0; i < sizeof buffers / sizeof *buffers; ++i) gpu_buffer_destroy(buffers[i]);
    block_raster_destroy(&blocks->raster);
    ribbon_store_destroy(&blocks->store);
    destroy_behind(&blocks->behind);
    *blocks = (Blocks){0};
}

Result blocks_begin(Blocks *blocks, uint64_t segments, const BlocksBase *base, Error *error)
{
    if (segments >= UINT32_MAX)
        return error_set(error, RESULT_FAILED,
                         "%llu segments of hair: at most %u can be drawn at once",
                         (unsigned long long)segments, UINT32_MAX - 1);
    blocks->stores = segments > blocks->most_slots;
    ribbon_store_destroy(&blocks->store);
    if (blocks->stores) TRY(ribbon_store_create(&blocks->store, (size_t)segments, error));
    int64_t count = 1 + (int64_t)(blocks->stores ? blocks->stored_slots : segments);
    const GpuLimits *limits = blocks->limits;
    TRY(make_room(&blocks->ribbons, limits, "ribbons", count * (int64_t)sizeof(RibbonRecord),
                  GL_RGBA32UI, error));
    TRY(make_room(&blocks->keys, limits, "depths", count * (int64_t)sizeof(RibbonKey), GL_RG32UI,
                  error));
    TRY(cull_begin(&blocks->cull, &base->cull, blocks->skips, error));
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
static Result project_part(Blocks *blocks, const HairBatch *batch, const Look *look,
                           const MaterialParams *part, int64_t slots, Error *error)
{
    int64_t first = (int64_t)blocks->slots, begin = first / ALIGNED_RIBBONS * ALIGNED_RIBBONS;
    gpu_uniforms_set(BIND_MATERIAL, part, sizeof *part);
    if (blocks->cull.tries) TRY(cull_list(&blocks->cull, batch, part, error));
    TRY(look_programs_use(&blocks->project, look, batch, error));
    bind_range(&blocks->ribbons, BIND_RIBBONS_OUT, begin, first + slots, sizeof(RibbonRecord));
    bind_range(&blocks->keys, BIND_KEYS_OUT, begin, first + slots, sizeof(RibbonKey));
    glUniform1i(0, (GLint)(first - begin));
    glUniform2i(1, (GLint)part->drawn_strands, blocks->cull.tries);
    gpu_dispatch(blocks->limits, part->drawn_strands, (uint64_t)blocks->limits->sizes.strands, 1);
    blocks->slots += (size_t)slots;
    blocks->strands += part->drawn_strands;
    return RESULT_OK;
}

// Moves what was projected so far to the store and empties its slots.
static Result store_ribbons(Blocks *blocks, Error *error)
{
    glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
    const RibbonKey *keys = map(&blocks->keys, blocks->keys.size);
    const RibbonRecord *records = map(&blocks->ribbons, blocks->ribbons.size);
    if (keys && records) ribbon_store_add(&blocks->store, keys, records, blocks->slots);
    if (keys) unmap(&blocks->keys);
    if (records) unmap(&blocks->ribbons);
    if (!keys || !records) return error_set(error, RESULT_FAILED, UNREADABLE);
    clear(&blocks->keys, (int64_t)(blocks->slots * sizeof(RibbonKey)));
    blocks->slots = 0;
    return RESULT_OK;
}

// The most strands with so many ribbons that a shader can see and the buffers hold at once.
static int64_t most_strands(const Blocks *blocks, int64_t of_strand)
{
    int64_t seen = blocks->limits->storage_block / (int64_t)sizeof(RibbonRecord) - ALIGNED_RIBBONS,
            most = blocks->stores ? smaller(seen, (int64_t)blocks->stored_slots) : seen;
    return most / of_strand;
}

Result blocks_add(Blocks *blocks, const HairBatch *batch, const Look *look, Error *error)
{
    MaterialParams part = look_material(look, batch);
    TRY(cull_make_room(&blocks->cull, part.drawn_strands, error));
    int64_t of_strand = (int64_t)(batch->vertex_count - 1) * part.smooth_parts,
            most = most_strands(blocks, of_strand);
    uint strands = part.drawn_strands;
    gpu_buffer_bind_texture(&batch->position, BIND_POSITION);
    gpu_buffer_bind_texture(&batch->strand_id, BIND_STRAND_ID);
    gpu_buffer_bind_storage(&blocks->counts, BIND_BLOCK_COUNTS_OUT);
    for (uint first = 0; first < strands; first += part.drawn_strands) {
        part.first_strand = first;
        part.drawn_strands = (uint)smaller(strands - first, most);
        int64_t slots = part.drawn_strands * of_strand;
        if (blocks->stores && blocks->slots + (size_t)slots > blocks->stored_slots)
            TRY(store_ribbons(blocks, error));
        TRY(project_part(blocks, batch, look, &part, slots, error));
    }
    return RESULT_OK;
}

void blocks_take_counts(Blocks *blocks, const uint32_t *counts, const uint32_t *tally)
{
    cull_count(&blocks->cull, tally);
    blocks->segments = blocks->culled = 0;
    for (int i = 0; i < BLOCK_COUNT_WORDS; i += 16) {
        blocks->segments += counts[i];
        blocks->culled += counts[i + 1];
    }
    blocks->culled += blocks->cull.outside;
    blocks->skips = blocks->culled + blocks->cull.hidden > blocks->strands / CULL_SHARE;
}

Result blocks_count(Blocks *blocks, Error *error)
{
    bool tries = blocks->cull.tries;
    const uint32_t *tally = tries ? map(&blocks->cull.tally, CULL_TALLY_BYTES) : NULL,
                   *counts = map(&blocks->counts, blocks->counts.size);
    bool good = counts && (tally || !tries);
    if (good) blocks_take_counts(blocks, counts, tally);
    if (tally) unmap(&blocks->cull.tally);
    if (counts) unmap(&blocks->counts);
    return good ? RESULT_OK : error_set(error, RESULT_FAILED, "hair's counts cannot be read");
}

static Result draw_scene(Blocks *blocks, const BlockScene *scene, GpuTimer *timer, Error *error)
{
    gpu_timer_begin(timer, "draw_bin");
    Result result = block_raster_bin(&blocks->raster, scene, &blocks->touched, error);
    gpu_timer_end(timer);
    gpu_timer_begin(timer, "draw_composite");
    if (result == RESULT_OK) block_raster_composite(&blocks->raster, scene);
    gpu_timer_end(timer);
    return result;
}

static Result draw_stored(Blocks *blocks, BlockScene *scene, GpuTimer *timer, Error *error)
{
    TRY(store_ribbons(blocks, error));
    scene->keys = blocks->store.keys;
    scene->records = blocks->store.records;
    scene->slots = blocks->store.count;
    Result result = draw_scene(blocks, scene, timer, error);
    ribbon_store_destroy(&blocks->store);
    return result;
}

static Result draw_mapped(Blocks *blocks, BlockScene *scene, GpuTimer *timer, Error *error)
{
    scene->keys = map(&blocks->keys, blocks->keys.size);
    scene->records = map(&blocks->ribbons, blocks->ribbons.size);
    Result result =
        scene->keys && scene->records ? RESULT_OK : error_set(error, RESULT_FAILED, UNREADABLE);
    THEN(result, draw_scene(blocks, scene, timer, error));
    if (scene->keys) unmap(&blocks->keys);
    if (scene->records) unmap(&blocks->ribbons);
    return result;
}

static Result read_behind(Blocks *blocks, BlockScene *scene, GpuTimer *timer, Error *error)
{
    const BlocksBase *base = &blocks->base;
    if (!base->cull.target) return RESULT_OK;
    memcpy(scene->style.depth, base->depth, sizeof scene->style.depth);
    gpu_timer_begin(timer, "draw_read");
    Result result = read_back(&blocks->behind, base->cull.target, base->box, base->version, error);
    gpu_timer_end(timer);
    scene->base = &blocks->behind.base;
    return result;
}

Result blocks_draw(Blocks *blocks, GpuTimer *timer, Image *image, Error *error)
{
    BlockScene scene = {
        .slots = blocks->slots, .style = blocks->style, .nearest = blocks->nearest, .image = image};
    glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
    TRY(blocks_count(blocks, error));
    TRY(read_behind(blocks, &scene, timer, error));
    return (blocks->stores ? draw_stored : draw_mapped)(blocks, &scene, timer, error);
}
