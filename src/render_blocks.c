// SPDX-License-Identifier: MIT
#include "render_blocks.h"

#include "draw.h"

#include <math.h>
#include <string.h>

enum {
    PROJECT_GROUP = 8,
    TILE_GROUP = 64,
    TILE_WIDTH = BLOCK_WIDTH * TILE_ACROSS, // px
    TILE_HEIGHT = BLOCK_HEIGHT * TILE_DOWN,
    RIBBON_BYTES = 16, // in each of four buffers
    NODE_BYTES = 8,
    FIRST_NODES = 1 << 14, // of a lane
    STATE_WORDS = 8,       // of a lane
    TILE_WORDS = 3         // before the tiles
};

// A lane's state in words (block_bin.comp).
enum { STATE_NODES = 1, STATE_STOPPED = 3 };
enum { STOPPED_DONE, STOPPED_BY_TURNS, STOPPED_BY_POOL };

static int64_t smaller(int64_t a, int64_t b)
{
    return a < b ? a : b;
}

// Tiles of the picture.
static int across(const RenderBlocks *blocks)
{
    return (blocks->width + TILE_WIDTH - 1) / TILE_WIDTH;
}

static int down(const RenderBlocks *blocks)
{
    return (blocks->height + TILE_HEIGHT - 1) / TILE_HEIGHT;
}

// Lists of a lane.
static int lists_of(const RenderBlocks *blocks, int rows)
{
    return across(blocks) * TILE_ACROSS * rows * TILE_DOWN;
}

static int64_t lane_nodes(const RenderBlocks *blocks)
{
    return blocks->links.size / NODE_BYTES / BIN_LANES;
}

static Result make_room(GpuBuffer *buffer, const GpuLimits *limits, const char *what, int64_t size,
                        GLenum format, Error *error)
{
    if (buffer->size >= size) return RESULT_OK;
    gpu_buffer_destroy(buffer);
    return gpu_buffer_create(buffer, limits, what, size, NULL, format, error);
}

static void clear(const GpuBuffer *buffer, int64_t size, GLuint value)
{
    glBindBuffer(GL_SHADER_STORAGE_BUFFER, buffer->buffer);
    glClearBufferSubData(GL_SHADER_STORAGE_BUFFER, GL_R32UI, 0, (GLsizeiptr)size, GL_RED_INTEGER,
                         GL_UNSIGNED_INT, &value);
}

static void read_back(const GpuBuffer *buffer, size_t size, void *data)
{
    glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT | GL_SHADER_STORAGE_BARRIER_BIT);
    glBindBuffer(GL_SHADER_STORAGE_BUFFER, buffer->buffer);
    glGetBufferSubData(GL_SHADER_STORAGE_BUFFER, 0, (GLsizeiptr)size, data);
}

static Result build_composite(RenderBlocks *blocks, int over_mesh, Error *error)
{
    const ShaderDefine defines[] = {{"BASE", over_mesh}, {"TONE", blocks->tone}, {NULL, 0}};
    return shader_build_compute(&blocks->composite[over_mesh], "block_composite.comp", defines,
                                error);
}

static Result build_programs(RenderBlocks *blocks, Error *error)
{
    const ShaderDefine bin[] = {{"BIN_GROUP", BIN_LANES / 2}, {NULL, 0}},
                       tile[] = {{"GROUP_SIZE", TILE_GROUP}, {NULL, 0}};
    blocks->project = (LookPrograms){.file = "block_project.comp", .group_size = PROJECT_GROUP};
    Result result = shader_build_compute(&blocks->bin, "block_bin.comp", bin, error);
    if (result == RESULT_OK)
        result = shader_build_compute(&blocks->tile, "block_tiles.comp", tile, error);
    return result == RESULT_OK ? build_composite(blocks, 0, error) : result;
}

static Result make_pool(RenderBlocks *blocks, int64_t nodes, Error *error)
{
    return make_room(&blocks->links, blocks->limits, "block lists", nodes * BIN_LANES * NODE_BYTES,
                     GL_RG32UI, error);
}

static uint32_t pack_background(const float background[4])
{
    uint32_t level[4];
    for (int k = 0; k < 4; ++k)
        level[k] = background[3] > 0 ? (uint32_t)lrintf(255 * background[k]) : 0;
    return level[0] | level[1] << 8 | level[2] << 16 | level[3] << 24;
}

static Result make_buffers(RenderBlocks *blocks, Error *error)
{
    const GpuLimits *limits = blocks->limits;
    int64_t tiles = (int64_t)across(blocks) * down(blocks);
    Result result = make_pool(blocks, smaller(FIRST_NODES, blocks->most_nodes), error);
    if (result == RESULT_OK)
        result = make_room(&blocks->lists, limits, "blocks",
                           (int64_t)lists_of(blocks, blocks->band_rows) * BIN_LANES * 4, GL_R32UI,
                           error);
    if (result == RESULT_OK)
        result = make_room(&blocks->states, limits, "lanes", BIN_LANES * STATE_WORDS * 4, 0, error);
    if (result == RESULT_OK)
        result = make_room(&blocks->counts, limits, "counts", BLOCK_COUNT_WORDS * 4, 0, error);
    if (result == RESULT_OK)
        result =
            make_room(&blocks->tiles, limits, "tiles", (TILE_WORDS + tiles) * 4, GL_R32UI, error);
    if (result == RESULT_OK)
        result = make_room(&blocks->pixels, limits, "picture", tiles * TILE_WIDTH * TILE_HEIGHT * 4,
                           0, error);
    return result;
}

Result render_blocks_create(RenderBlocks *blocks, const GpuLimits *limits, int width, int height,
                            const float background[4], int tone, int64_t pool_bytes, Error *error)
{
    *blocks = (RenderBlocks){.limits = limits,
                             .width = width,
                             .height = height,
                             .background = pack_background(background),
                             .tone = tone};
    int64_t bytes = pool_bytes ? smaller(pool_bytes, limits->storage_block) : limits->storage_block;
    int64_t most = smaller(bytes / NODE_BYTES, limits->texture_texels) / BIN_LANES;
    blocks->most_nodes = most < 64 ? 64 : most;
    int64_t row_bytes = (int64_t)lists_of(blocks, 1) * BIN_LANES * 4,
            rows = smaller(limits->storage_block, limits->texture_texels * 4) / row_bytes;
    blocks->band_rows = (int)smaller(rows, down(blocks));
    Result result = build_programs(blocks, error);
    if (result == RESULT_OK) result = make_buffers(blocks, error);
    if (result != RESULT_OK) render_blocks_destroy(blocks);
    return result;
}

void render_blocks_destroy(RenderBlocks *blocks)
{
    const GLuint programs[] = {blocks->bin, blocks->tile, blocks->composite[0],
                               blocks->composite[1]};
    GpuBuffer *const buffers[] = {
        &blocks->lines,  &blocks->shapes, &blocks->tints,   &blocks->spans,  &blocks->keys,
        &blocks->order,  &blocks->lists,  &blocks->links,   &blocks->states, &blocks->tiles,
        &blocks->counts, &blocks->pixels, &blocks->material};
    look_programs_destroy(&blocks->project);
    for (size_t i = 0; i < sizeof programs / sizeof *programs; ++i)
        if (programs[i]) glDeleteProgram(programs[i]);
    for (size_t i = 0; i < sizeof buffers / sizeof *buffers; ++i) gpu_buffer_destroy(buffers[i]);
    radix_destroy(&blocks->radix);
    *blocks = (RenderBlocks){0};
}

Result render_blocks_add_mesh(RenderBlocks *blocks, Error *error)
{
    return blocks->composite[1] ? RESULT_OK : build_composite(blocks, 1, error);
}

bool render_blocks_can_hold(const GpuLimits *limits, uint64_t segments)
{
    int64_t most = smaller(limits->storage_block, limits->texture_texels * 16) / RIBBON_BYTES;
    return segments <= (uint64_t)smaller(most, INT32_MAX / 3);
}

Result render_blocks_begin(RenderBlocks *blocks, uint64_t segments, Error *error)
{
    int64_t count = segments ? (int64_t)segments : 1;
    const GpuLimits *limits = blocks->limits;
    Result result =
        make_room(&blocks->lines, limits, "ribbons", count * RIBBON_BYTES, GL_RGBA32UI, error);
    if (result == RESULT_OK)
        result =
            make_room(&blocks->shapes, limits, "shapes", count * RIBBON_BYTES, GL_RGBA32UI, error);
    if (result == RESULT_OK)
        result =
            make_room(&blocks->tints, limits, "tints", count * RIBBON_BYTES, GL_RGBA32UI, error);
    if (result == RESULT_OK)
        result =
            make_room(&blocks->spans, limits, "spans", count * RIBBON_BYTES, GL_RGBA32UI, error);
    if (result == RESULT_OK)
        result = make_room(&blocks->keys, limits, "depths", count * 4, 0, error);
    if (result == RESULT_OK)
        result = make_room(&blocks->order, limits, "order", count * 4, GL_R32UI, error);
    if (result != RESULT_OK) return result;
    clear(&blocks->keys, count * 4, 0);
    clear(&blocks->counts, blocks->counts.size, 0);
    clear(&blocks->pixels, blocks->pixels.size, blocks->background);
    blocks->slots = 0;
    blocks->redraws = blocks->bands = 0;
    blocks->nodes = 0;
    return RESULT_OK;
}

Result render_blocks_add(RenderBlocks *blocks, const HairBatch *batch, const Look *look,
                         Error *error)
{
    Result result = look_programs_use(&blocks->project, look, batch, error);
    if (result != RESULT_OK) return result;
    MaterialParams whole = look_material(look, batch);
    gpu_uniforms_set(&blocks->material, BIND_MATERIAL, &whole, sizeof whole);
    gpu_buffer_bind_texture(&batch->position, BIND_POSITION);
    gpu_buffer_bind_texture(&batch->strand_id, BIND_STRAND_ID);
    gpu_buffer_bind_storage(&blocks->lines, BIND_LINES_OUT);
    gpu_buffer_bind_storage(&blocks->shapes, BIND_SHAPES_OUT);
    gpu_buffer_bind_storage(&blocks->tints, BIND_TINTS_OUT);
    gpu_buffer_bind_storage(&blocks->spans, BIND_SPANS_OUT);
    gpu_buffer_bind_storage(&blocks->keys, BIND_KEYS_OUT);
    gpu_buffer_bind_storage(&blocks->counts, BIND_BLOCK_COUNTS_OUT);
    glUniform1i(0, (GLint)blocks->slots);
    glDispatchCompute((whole.drawn_strands + PROJECT_GROUP - 1) / PROJECT_GROUP, 1, 1);
    blocks->slots += (size_t)batch->strand_count * (batch->vertex_count - 1) * whole.smooth_parts;
    return RESULT_OK;
}

static Result sort(RenderBlocks *blocks, Error *error)
{
    GLuint counts[BLOCK_COUNT_WORDS];
    read_back(&blocks->counts, sizeof counts, counts);
    blocks->segments = blocks->culled = blocks->ribbons = 0;
    for (int i = 0; i < BLOCK_COUNT_WORDS; i += 16) {
        blocks->segments += counts[i];
        blocks->culled += counts[i + 1];
    }
    if (blocks->segments == 0) return RESULT_OK;
    GLsizeiptr size = (GLsizeiptr)(blocks->slots * 4);
    glBindBuffer(GL_SHADER_STORAGE_BUFFER, blocks->keys.buffer);
    const GLuint *keys = glMapBufferRange(GL_SHADER_STORAGE_BUFFER, 0, size, GL_MAP_READ_BIT);
    glBindBuffer(GL_COPY_WRITE_BUFFER, blocks->order.buffer);
    GLuint *order = glMapBufferRange(GL_COPY_WRITE_BUFFER, 0, size,
                                     GL_MAP_WRITE_BIT | GL_MAP_INVALIDATE_BUFFER_BIT);
    Result result = keys && order ? radix_sort_descending(&blocks->radix, keys, blocks->slots,
                                                          order, &blocks->ribbons, error)
                                  : error_set(error, RESULT_FAILED, "hair's depths cannot be read");
    if (keys) glUnmapBuffer(GL_SHADER_STORAGE_BUFFER);
    if (order) glUnmapBuffer(GL_COPY_WRITE_BUFFER);
    return result;
}

// Deals out what touches the rows of blocks; *full if the pool did not hold it.
static void bin_band(RenderBlocks *blocks, int row, int end, bool *full)
{
    GLint states[BIN_LANES][STATE_WORDS];
    bool going = true;
    *full = false;
    clear(&blocks->lists, (int64_t)lists_of(blocks, end - row) * BIN_LANES * 4, 0);
    clear(&blocks->states, blocks->states.size, 0);
    gpu_buffer_bind_texture(&blocks->spans, BIND_SPANS);
    gpu_buffer_bind_texture(&blocks->order, BIND_ORDER);
    gpu_buffer_bind_storage(&blocks->lists, BIND_LISTS_OUT);
    gpu_buffer_bind_storage(&blocks->links, BIND_LINKS_OUT);
    gpu_buffer_bind_storage(&blocks->states, BIND_BIN_STATE_OUT);
    glUseProgram(blocks->bin);
    glUniform4i(0, (GLint)blocks->ribbons, (GLint)lane_nodes(blocks), row * TILE_DOWN,
                end * TILE_DOWN);
    glUniform1i(1, across(blocks) * TILE_ACROSS);
    while (going && !*full) {
        going = false;
        glDispatchCompute(2, 1, 1);
        read_back(&blocks->states, sizeof states, states);
        for (int i = 0; i < BIN_LANES; ++i) {
            if (states[i][STATE_STOPPED] == STOPPED_BY_POOL) *full = true;
            if (states[i][STATE_STOPPED] == STOPPED_BY_TURNS) going = true;
        }
    }
    for (int i = 0; i < BIN_LANES && !*full; ++i) blocks->nodes += (uint64_t)states[i][STATE_NODES];
}

// Finds the band's tiles that are not background, and how many they are.
static void find_tiles(const RenderBlocks *blocks, const int box[4], int row, int end)
{
    const GLuint command[TILE_WORDS] = {0, 1, 1};
    GLuint count = (GLuint)(across(blocks) * (end - row));
    glBindBuffer(GL_SHADER_STORAGE_BUFFER, blocks->tiles.buffer);
    glBufferSubData(GL_SHADER_STORAGE_BUFFER, 0, sizeof command, command);
    gpu_buffer_bind_texture(&blocks->lists, BIND_LISTS);
    gpu_buffer_bind_storage(&blocks->tiles, BIND_TILES_OUT);
    glUseProgram(blocks->tile);
    glUniform4i(0, across(blocks), end - row, row, lists_of(blocks, end - row));
    glUniform4i(1, box[0] / TILE_WIDTH, box[1] / TILE_HEIGHT, box[2] / TILE_WIDTH,
                box[3] / TILE_HEIGHT);
    glDispatchCompute((count + TILE_GROUP - 1) / TILE_GROUP, 1, 1);
    glMemoryBarrier(GL_TEXTURE_FETCH_BARRIER_BIT | GL_COMMAND_BARRIER_BIT);
}

static void composite_band(const RenderBlocks *blocks, const RenderTarget *target, bool over_mesh,
                           const int box[4], int row, int end)
{
    glMemoryBarrier(GL_TEXTURE_FETCH_BARRIER_BIT);
    find_tiles(blocks, box, row, end);
    gpu_buffer_bind_texture(&blocks->lines, BIND_LINES);
    gpu_buffer_bind_texture(&blocks->shapes, BIND_SHAPES);
    gpu_buffer_bind_texture(&blocks->tints, BIND_TINTS);
    gpu_buffer_bind_texture(&blocks->links, BIND_LINKS);
    gpu_buffer_bind_texture(&blocks->tiles, BIND_TILES);
    gpu_buffer_bind_storage(&blocks->pixels, BIND_PIXELS_OUT);
    gpu_buffer_bind_storage(&blocks->counts, BIND_BLOCK_COUNTS_OUT);
    if (over_mesh) {
        glActiveTexture(GL_TEXTURE0 + BIND_BASE);
        glBindTexture(GL_TEXTURE_2D, target->base);
        glActiveTexture(GL_TEXTURE0 + BIND_MESH_DEPTH);
        glBindTexture(GL_TEXTURE_2D, target->depth);
    }
    glUseProgram(blocks->composite[over_mesh]);
    glUniform4i(0, across(blocks), end - row, row, lists_of(blocks, end - row));
    glBindBuffer(GL_DISPATCH_INDIRECT_BUFFER, blocks->tiles.buffer);
    glDispatchComputeIndirect(0);
}

// After a band that did not fit: a larger pool or, where there can be none, fewer rows.
static Result make_it_fit(RenderBlocks *blocks, int rows, Error *error)
{
    int64_t nodes = lane_nodes(blocks);
    ++blocks->redraws;
    if (nodes < blocks->most_nodes) {
        return make_pool(blocks, smaller(2 * nodes, blocks->most_nodes), error);
    }
    if (rows == 1)
        return error_set(error, RESULT_FAILED,
                         "one row of blocks of the picture needs more hair lists than %lld bytes "
                         "hold",
                         (long long)blocks->links.size);
    blocks->band_rows = rows / 2;
    return RESULT_OK;
}

Result render_blocks_draw(RenderBlocks *blocks, const RenderTarget *target, bool over_mesh,
                          const int box[4], GpuTimer *timer, Error *error)
{
    gpu_timer_begin(timer, "draw_sort");
    glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT | GL_TEXTURE_FETCH_BARRIER_BIT);
    Result result = sort(blocks, error);
    gpu_timer_end(timer);
    for (int row = 0; row < down(blocks) && result == RESULT_OK;) {
        bool full;
        int end = row + (int)smaller(blocks->band_rows, down(blocks) - row);
        gpu_timer_begin(timer, "draw_bin");
        bin_band(blocks, row, end, &full);
        gpu_timer_end(timer);
        if (full) {
            result = make_it_fit(blocks, end - row, error);
            continue;
        }
        gpu_timer_begin(timer, "draw_composite");
        composite_band(blocks, target, over_mesh, box, row, end);
        gpu_timer_end(timer);
        ++blocks->bands;
        row = end;
    }
    return result;
}

bool render_blocks_fell_short(const RenderBlocks *blocks)
{
    GLuint counts[BLOCK_COUNT_WORDS];
    read_back(&blocks->counts, sizeof counts, counts);
    return counts[BLOCK_COUNT_SHORT] != 0;
}

static void copy_row(const RenderBlocks *blocks, const uint8_t *from, uint8_t *to, int channels)
{
    if (channels == 4) {
        memcpy(to, from, (size_t)blocks->width * 4);
        return;
    }
    for (int x = 0; x < blocks->width; ++x, from += 4, to += 3)
        to[0] = from[0], to[1] = from[1], to[2] = from[2];
}

void render_blocks_read(const RenderBlocks *blocks, Image *image)
{
    size_t pitch = (size_t)across(blocks) * TILE_WIDTH * 4;
    glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
    glBindBuffer(GL_SHADER_STORAGE_BUFFER, blocks->pixels.buffer);
    const uint8_t *pixels = glMapBufferRange(GL_SHADER_STORAGE_BUFFER, 0,
                                             (GLsizeiptr)blocks->pixels.size, GL_MAP_READ_BIT);
    for (int y = 0; pixels && y < blocks->height; ++y)
        copy_row(blocks, pixels + (size_t)y * pitch,
                 image->pixels + (size_t)y * (size_t)image->width * (size_t)image->channels,
                 image->channels);
    if (pixels) glUnmapBuffer(GL_SHADER_STORAGE_BUFFER);
}
