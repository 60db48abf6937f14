// SPDX-License-Identifier: MIT
#include "render_blocks.h"

#include "draw.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum {
    PROJECT_GROUP = 8,
    RIBBON_BYTES = RIBBON_TEXELS * 16,
    NUMBER_BYTES = 4,   // of a ribbon in a list
    LEAST_NUMBERS = 64, // that there is always room for
    FIRST_NUMBERS = 1 << 16,
    CULL_SHARE = 16,     // of the strands left out: looking for them pays
    ALIGNED_RIBBONS = 16 // at whose multiples every driver lets a buffer's range begin
};

_Static_assert((int)JOB_GROUP == BLOCK_GROUP, "a group of jobs is a work group");

static int64_t smaller(int64_t a, int64_t b)
{
    return a < b ? a : b;
}

static Result make_room(GpuBuffer *buffer, const GpuLimits *limits, const char *what, int64_t size,
                        GLenum format, Error *error)
{
    if (buffer->size >= size) return RESULT_OK;
    gpu_buffer_destroy(buffer);
    return gpu_buffer_create(buffer, limits, what, size, NULL, format, error);
}

static void clear(const GpuBuffer *buffer, int64_t size)
{
    const GLuint zero = 0;
    glBindBuffer(GL_SHADER_STORAGE_BUFFER, buffer->buffer);
    glClearBufferSubData(GL_SHADER_STORAGE_BUFFER, GL_R32UI, 0, (GLsizeiptr)size, GL_RED_INTEGER,
                         GL_UNSIGNED_INT, &zero);
}

static void clear_pixels(const RenderBlocks *blocks)
{
    glBindBuffer(GL_SHADER_STORAGE_BUFFER, blocks->pixels.buffer);
    glClearBufferSubData(GL_SHADER_STORAGE_BUFFER, GL_RGBA32UI, 0, (GLsizeiptr)blocks->pixels.size,
                         GL_RGBA_INTEGER, GL_UNSIGNED_INT, blocks->background);
}

static void read_back(const GpuBuffer *buffer, size_t size, void *data)
{
    glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT | GL_SHADER_STORAGE_BARRIER_BIT);
    glBindBuffer(GL_SHADER_STORAGE_BUFFER, buffer->buffer);
    glGetBufferSubData(GL_SHADER_STORAGE_BUFFER, 0, (GLsizeiptr)size, data);
}

// Maps the first `size` bytes; NULL on failure.
static void *map(const GpuBuffer *buffer, int64_t size, GLbitfield access)
{
    glBindBuffer(GL_SHADER_STORAGE_BUFFER, buffer->buffer);
    return glMapBufferRange(GL_SHADER_STORAGE_BUFFER, 0, (GLsizeiptr)size, access);
}

static void unmap(const GpuBuffer *buffer)
{
    glBindBuffer(GL_SHADER_STORAGE_BUFFER, buffer->buffer);
    glUnmapBuffer(GL_SHADER_STORAGE_BUFFER);
}

static Result build_composite(RenderBlocks *blocks, int over_mesh, Error *error)
{
    const ShaderDefine defines[] = {{"BASE", over_mesh},
                                    {"TONE", blocks->tone},
                                    {"SAMPLES", blocks->samples},
                                    {"KIND", (int)blocks->kind},
                                    {"NEAREST", blocks->aov > AOV_COVERAGE},
                                    {"DEPTH", blocks->aov == AOV_DEPTH},
                                    {NULL, 0}};
    return shader_build_compute(&blocks->composite[over_mesh], "block_composite.comp", defines,
                                error);
}

// As block_composite.comp packs pixels.
static void pack_background(const RendererOptions *options, uint32_t words[4])
{
    float light[4];
    uint32_t level[4], most = options->kind == IMAGE_8 ? 255 : 65535;
    picture_background(options, light);
    for (int k = 0; k < 4; ++k)
        level[k] = light[3] > 0 ? (uint32_t)lrintf((float)most * options->background[k]) : 0;
    for (int i = 0; i < 4; ++i)
        if (options->kind == IMAGE_8)
            words[i] = level[0] | level[1] << 8 | level[2] << 16 | level[3] << 24;
        else if (options->kind == IMAGE_16)
            words[i] = level[i % 2 * 2] | level[i % 2 * 2 + 1] << 16;
        else
            memcpy(&words[i], &light[i], sizeof light[i]);
}

static int columns(const RenderBlocks *blocks)
{
    return (blocks->width + BLOCK_WIDTH - 1) / BLOCK_WIDTH;
}

static int rows(const RenderBlocks *blocks)
{
    return (blocks->height + BLOCK_HEIGHT - 1) / BLOCK_HEIGHT;
}

// Between two rows of the picture.
static int64_t pitch(const RenderBlocks *blocks)
{
    return (int64_t)columns(blocks) * BLOCK_WIDTH / blocks->samples * 4 *
           (int64_t)image_channel_size(blocks->kind);
}

// With a row for lanes that have nothing to do.
static int64_t picture_bytes(const RenderBlocks *blocks)
{
    return pitch(blocks) * (rows(blocks) + 1) * BLOCK_HEIGHT / blocks->samples;
}

static Result make_buffers(RenderBlocks *blocks, Error *error)
{
    const GpuLimits *limits = blocks->limits;
    Result result = block_lists_create(&blocks->lists, columns(blocks), rows(blocks), BLOCK_WIDTH,
                                       BLOCK_HEIGHT, error);
    if (result == RESULT_OK)
        result = make_room(&blocks->counts, limits, "counts", BLOCK_COUNT_WORDS * 4, 0, error);
    if (result == RESULT_OK)
        result = make_room(&blocks->pixels, limits, "picture", picture_bytes(blocks), 0, error);
    return result;
}

static RenderBlocks describe(const GpuLimits *limits, const RendererOptions *options)
{
    return (RenderBlocks){.project = {.file = "block_project.comp", .group_size = PROJECT_GROUP},
                          .limits = limits,
                          .width = options->width * options->samples,
                          .height = options->height * options->samples,
                          .samples = options->samples,
                          .skips = true,
                          .kind = options->kind,
                          .aov = options->aov,
                          .tone = picture_display(options)};
}

bool render_blocks_can_store(const GpuLimits *limits, const RendererOptions *options)
{
    RenderBlocks blocks = describe(limits, options);
    return picture_bytes(&blocks) <= limits->storage_block;
}

Result render_blocks_create(RenderBlocks *blocks, const GpuLimits *limits,
                            const RendererOptions *options, Error *error)
{
    *blocks = describe(limits, options);
    pack_background(options, blocks->background);
    int64_t bytes = options->pool_bytes ? smaller(options->pool_bytes, limits->storage_block)
                                        : limits->storage_block;
    int64_t most = smaller(bytes / NUMBER_BYTES, limits->texture_texels);
    blocks->most_numbers = most < LEAST_NUMBERS ? LEAST_NUMBERS : most;
    Result result = build_composite(blocks, 0, error);
    if (result == RESULT_OK) result = make_buffers(blocks, error);
    if (result != RESULT_OK) render_blocks_destroy(blocks);
    return result;
}

void render_blocks_destroy(RenderBlocks *blocks)
{
    GpuBuffer *const buffers[] = {&blocks->ribbons, &blocks->keys,   &blocks->numbers,
                                  &blocks->jobs,    &blocks->counts, &blocks->pixels,
                                  &blocks->material};
    look_programs_destroy(&blocks->project);
    render_cull_destroy(&blocks->cull);
    for (int i = 0; i < 2; ++i)
        if (blocks->composite[i]) glDeleteProgram(blocks->composite[i]);
    for (size_t i = 0; i < sizeof buffers / sizeof *buffers; ++i) gpu_buffer_destroy(buffers[i]);
    block_lists_destroy(&blocks->lists);
    radix_destroy(&blocks->radix);
    free(blocks->order);
    *blocks = (RenderBlocks){0};
}

Result render_blocks_add_base(RenderBlocks *blocks, Error *error)
{
    return blocks->composite[1] ? RESULT_OK : build_composite(blocks, 1, error);
}

bool render_blocks_can_hold(const GpuLimits *limits, uint64_t segments)
{
    int64_t most = smaller(limits->storage_block / 4, limits->texture_texels / RIBBON_TEXELS);
    return segments + ALIGNED_RIBBONS <= (uint64_t)smaller(most, INT32_MAX / RIBBON_TEXELS);
}

static Result make_order(RenderBlocks *blocks, size_t count, Error *error)
{
    if (blocks->order_room >= count) return RESULT_OK;
    free(blocks->order);
    blocks->order_room = 0;
    blocks->order = malloc(count * sizeof *blocks->order);
    if (!blocks->order)
        return error_set(error, RESULT_FAILED, "no memory to sort %zu ribbons", count);
    blocks->order_room = count;
    return RESULT_OK;
}

Result render_blocks_begin(RenderBlocks *blocks, uint64_t segments, const CullBase *base,
                           Error *error)
{
    int64_t count = segments ? (int64_t)segments : 1;
    const GpuLimits *limits = blocks->limits;
    Result result = make_order(blocks, (size_t)count, error);
    if (result == RESULT_OK && blocks->ribbons.size < count * RIBBON_BYTES) {
        gpu_buffer_destroy(&blocks->ribbons);
        result = gpu_buffer_create_pieces(&blocks->ribbons, limits, "ribbons", count * RIBBON_BYTES,
                                          GL_RGBA32UI, error);
    }
    if (result == RESULT_OK)
        result = make_room(&blocks->keys, limits, "depths", count * 4, 0, error);
    if (result == RESULT_OK)
        result = render_cull_begin(&blocks->cull, limits, base, blocks->skips, error);
    if (result != RESULT_OK) return result;
    clear(&blocks->keys, count * 4);
    clear(&blocks->counts, blocks->counts.size);
    clear_pixels(blocks);
    blocks->slots = 0;
    blocks->strands = 0;
    blocks->bands = 0;
    blocks->touched = 0;
    return RESULT_OK;
}

// Projects part.drawn_strands strands from part.first_strand on, whose ribbons a shader can see at
// once.
static Result project_part(RenderBlocks *blocks, const HairBatch *batch, const Look *look,
                           const MaterialParams *part, int64_t slots, Error *error)
{
    int64_t first = (int64_t)blocks->slots, begin = first / ALIGNED_RIBBONS * ALIGNED_RIBBONS;
    uint32_t count = part->drawn_strands;
    gpu_uniforms_set(&blocks->material, BIND_MATERIAL, part, sizeof *part);
    Result result = RESULT_OK;
    if (blocks->cull.tries) result = render_cull_list(&blocks->cull, batch, part, &count, error);
    if (result == RESULT_OK) result = look_programs_use(&blocks->project, look, batch, error);
    if (result != RESULT_OK) return result;
    glBindBufferRange(GL_SHADER_STORAGE_BUFFER, BIND_RIBBONS_OUT, blocks->ribbons.buffer,
                      (GLintptr)(begin * RIBBON_BYTES),
                      (GLsizeiptr)((first + slots - begin) * RIBBON_BYTES));
    glUniform2i(0, (GLint)first, (GLint)(first - begin));
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
            most = (blocks->limits->storage_block / RIBBON_BYTES - ALIGNED_RIBBONS) / of_strand;
    uint strands = part.drawn_strands;
    gpu_buffer_bind_texture(&batch->position, BIND_POSITION);
    gpu_buffer_bind_texture(&batch->strand_id, BIND_STRAND_ID);
    gpu_buffer_bind_storage(&blocks->keys, BIND_KEYS_OUT);
    gpu_buffer_bind_storage(&blocks->counts, BIND_BLOCK_COUNTS_OUT);
    for (uint first = 0; first < strands && result == RESULT_OK; first += part.drawn_strands) {
        part.first_strand = first;
        part.drawn_strands = (uint)smaller(strands - first, most);
        result = project_part(blocks, batch, look, &part, part.drawn_strands * of_strand, error);
    }
    return result;
}

static Result sort(RenderBlocks *blocks, Error *error)
{
    GLuint counts[BLOCK_COUNT_WORDS];
    read_back(&blocks->counts, sizeof counts, counts);
    blocks->segments = blocks->culled = blocks->seen = 0;
    for (int i = 0; i < BLOCK_COUNT_WORDS; i += 16) {
        blocks->segments += counts[i];
        blocks->culled += counts[i + 1];
    }
    blocks->culled += blocks->cull.outside;
    blocks->skips = blocks->culled + blocks->cull.hidden > blocks->strands / CULL_SHARE;
    if (blocks->segments == 0) return RESULT_OK;
    const GLuint *keys = map(&blocks->keys, (int64_t)blocks->slots * 4, GL_MAP_READ_BIT);
    if (!keys) return error_set(error, RESULT_FAILED, "hair's depths cannot be read");
    Result result = radix_sort_descending(&blocks->radix, keys, blocks->slots, blocks->order,
                                          &blocks->seen, error);
    unmap(&blocks->keys);
    return result;
}

// Room for the numbers of rows from `row` on, as many as may be: the lists grow as long as they
// may.
static Result fit_band(RenderBlocks *blocks, int row, int *end, Error *error)
{
    uint64_t size;
    *end = block_lists_fit(&blocks->lists, row, (uint64_t)blocks->most_numbers, &size);
    if (*end == row)
        return error_set(error, RESULT_FAILED,
                         "one row of blocks of the picture needs more hair lists than %lld bytes "
                         "hold",
                         (long long)blocks->most_numbers * NUMBER_BYTES);
    int64_t room = blocks->numbers.size / NUMBER_BYTES, needed = (int64_t)size;
    if (needed > room || room == 0) {
        room = room ? 2 * room : FIRST_NUMBERS;
        if (room < needed) room = needed + needed / 4;
        room = smaller(room, blocks->most_numbers);
    }
    return make_room(&blocks->numbers, blocks->limits, "block lists", room * NUMBER_BYTES, GL_R32UI,
                     error);
}

static int block_of(int px, int size)
{
    return px < 0 ? -1 : px / size;
}

static Result count_touched(RenderBlocks *blocks, Error *error)
{
    const RibbonRecord *ribbons = map(&blocks->ribbons, blocks->ribbons.size, GL_MAP_READ_BIT);
    if (!ribbons) return error_set(error, RESULT_FAILED, "hair's ribbons cannot be read");
    blocks->touched = block_lists_count(&blocks->lists, ribbons, blocks->order, blocks->seen);
    unmap(&blocks->ribbons);
    return RESULT_OK;
}

// Makes the lists of the rows, and how many groups of jobs they are.
static Result deal_band(RenderBlocks *blocks, const int box[4], int row, int end, size_t *groups,
                        Error *error)
{
    const GLbitfield write = GL_MAP_WRITE_BIT | GL_MAP_INVALIDATE_BUFFER_BIT;
    const int in_blocks[4] = {block_of(box[0], BLOCK_WIDTH), block_of(box[1], BLOCK_HEIGHT),
                              block_of(box[2], BLOCK_WIDTH), block_of(box[3], BLOCK_HEIGHT)};
    const RibbonRecord *ribbons = map(&blocks->ribbons, blocks->ribbons.size, GL_MAP_READ_BIT);
    uint32_t *numbers = map(&blocks->numbers, blocks->numbers.size, write);
    size_t count = block_lists_place(&blocks->lists, row, end, in_blocks);
    *groups = count / BLOCK_GROUP;
    Result result = make_room(&blocks->jobs, blocks->limits, "blocks",
                              (int64_t)(count + 1) * (int64_t)sizeof(BlockJob), GL_RGBA32UI, error);
    BlockJob *jobs = result == RESULT_OK ? map(&blocks->jobs, blocks->jobs.size, write) : NULL;
    bool mapped = ribbons && jobs && numbers;
    if (mapped) {
        block_lists_write_jobs(&blocks->lists, jobs);
        block_lists_fill(&blocks->lists, ribbons, blocks->order, blocks->seen, row, end, numbers);
    }
    if (ribbons) unmap(&blocks->ribbons);
    if (jobs) unmap(&blocks->jobs);
    if (numbers) unmap(&blocks->numbers);
    return mapped ? RESULT_OK : error_set(error, RESULT_FAILED, "block lists cannot be written");
}

static void composite_band(const RenderBlocks *blocks, const RenderTarget *target, bool over_mesh,
                           size_t groups)
{
    glMemoryBarrier(GL_TEXTURE_FETCH_BARRIER_BIT);
    gpu_buffer_bind_texture(&blocks->ribbons, BIND_RIBBONS);
    gpu_buffer_bind_texture(&blocks->jobs, BIND_JOBS);
    gpu_buffer_bind_texture(&blocks->numbers, BIND_LISTS);
    gpu_buffer_bind_storage(&blocks->pixels, BIND_PIXELS_OUT);
    gpu_buffer_bind_storage(&blocks->counts, BIND_BLOCK_COUNTS_OUT);
    if (over_mesh) {
        glActiveTexture(GL_TEXTURE0 + BIND_BASE);
        glBindTexture(GL_TEXTURE_2D, target->base);
        glActiveTexture(GL_TEXTURE0 + BIND_MESH_DEPTH);
        glBindTexture(GL_TEXTURE_2D, target->depth);
    }
    glUseProgram(blocks->composite[over_mesh]);
    glUniform1i(0, blocks->lists.columns);
    if (groups) glDispatchCompute((GLuint)groups, 1, 1);
}

// Deals all ribbons out and composites them, in as many bands of rows as the lists need.
static Result draw_bands(RenderBlocks *blocks, const RenderTarget *target, bool over_mesh,
                         const int box[4], GpuTimer *timer, Error *error)
{
    gpu_timer_begin(timer, "draw_bin");
    Result result = count_touched(blocks, error);
    gpu_timer_end(timer);
    for (int row = 0, end; row < blocks->lists.rows && result == RESULT_OK; row = end) {
        size_t groups = 0;
        gpu_timer_begin(timer, "draw_bin");
        result = fit_band(blocks, row, &end, error);
        if (result == RESULT_OK) result = deal_band(blocks, box, row, end, &groups, error);
        gpu_timer_end(timer);
        gpu_timer_begin(timer, "draw_composite");
        if (result == RESULT_OK) composite_band(blocks, target, over_mesh, groups);
        gpu_timer_end(timer);
        ++blocks->bands;
    }
    return result;
}

Result render_blocks_draw(RenderBlocks *blocks, const RenderTarget *target, bool over_mesh,
                          const int box[4], GpuTimer *timer, Error *error)
{
    gpu_timer_begin(timer, "draw_sort");
    glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT | GL_TEXTURE_FETCH_BARRIER_BIT);
    Result result = sort(blocks, error);
    gpu_timer_end(timer);
    if (result == RESULT_OK) result = draw_bands(blocks, target, over_mesh, box, timer, error);
    return result;
}

bool render_blocks_fell_short(const RenderBlocks *blocks)
{
    GLuint counts[BLOCK_COUNT_WORDS];
    read_back(&blocks->counts, sizeof counts, counts);
    return counts[BLOCK_COUNT_SHORT] != 0;
}

static void copy_row(const Image *image, const uint8_t *from, uint8_t *to)
{
    size_t width = (size_t)image->width, size = image_channel_size(image->kind);
    if (image->channels == 4)
        memcpy(to, from, width * 4 * size);
    else if (image->kind == IMAGE_8)
        for (size_t x = 0; x < width; ++x, from += 4, to += 3)
            to[0] = from[0], to[1] = from[1], to[2] = from[2];
    else
        for (size_t x = 0; x < width; ++x) memcpy(to + x * 3 * size, from + x * 4 * size, 3 * size);
}

void render_blocks_read(const RenderBlocks *blocks, Image *image)
{
    size_t row_bytes =
        (size_t)image->width * (size_t)image->channels * image_channel_size(image->kind);
    glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
    const uint8_t *pixels = map(&blocks->pixels, blocks->pixels.size, GL_MAP_READ_BIT);
    for (int y = 0; pixels && y < image->height; ++y)
        copy_row(image, pixels + y * pitch(blocks), image->pixels + (size_t)y * row_bytes);
    if (pixels) unmap(&blocks->pixels);
}
