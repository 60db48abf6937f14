// SPDX-License-Identifier: MIT
#include "draw/cull.h"

#include "gpu/gpu_dispatch.h"

#include "glsl/draw/draw.h"

#include <stddef.h>

// --- Tiles of what hides.

typedef struct Tiles {
    float *tile; // [rows][stride]
    int columns, rows, stride;
} Tiles;

static float least(float a, float b)
{
    return b < a ? b : a;
}

static int at_most(int a, int b)
{
    return a < b ? a : b;
}

// The least of the tiles in columns x .. end_x - 1 and rows y .. end_y - 1.
static float least_of(const Tiles *tiles, int x, int y, int end_x, int end_y)
{
    const float *row = tiles->tile + (ptrdiff_t)y * tiles->stride;
    float found = row[x];
    for (; y < end_y; ++y, row += tiles->stride)
        for (int i = x; i < end_x; ++i) found = least(found, row[i]);
    return found;
}

static void spread_tiles(const Tiles *tiles, float *level)
{
    for (int y = 0; y < tiles->rows; ++y)
        for (int x = 0; x < tiles->columns; ++x)
            level[(ptrdiff_t)y * tiles->stride + x] =
                least_of(tiles, x ? x - 1 : 0, y ? y - 1 : 0, at_most(x + 2, tiles->columns),
                         at_most(y + 2, tiles->rows));
}

// In place: a tile is written when all that lie there have been read.
static void halve(Tiles *tiles)
{
    int columns = (tiles->columns + 1) / 2, rows = (tiles->rows + 1) / 2;
    for (int y = 0; y < rows; ++y)
        for (int x = 0; x < columns; ++x)
            tiles->tile[(ptrdiff_t)y * tiles->stride + x] =
                least_of(tiles, 2 * x, 2 * y, at_most(2 * x + 2, tiles->columns),
                         at_most(2 * y + 2, tiles->rows));
    tiles->columns = columns;
    tiles->rows = rows;
}

void cull_make_levels(float *nearest, int columns, int rows, float *levels)
{
    Tiles tiles = {nearest, columns, rows, columns};
    for (int k = 0; k < HIDE_LEVELS; ++k, levels += (ptrdiff_t)rows * columns) {
        spread_tiles(&tiles, levels);
        halve(&tiles);
    }
}

// --- Strands that are out of sight.

enum { HEAD_WORDS = 1 }; // of `listed`, before the rows

_Static_assert((int)HIDE_LEVELS == HIDE_LEVELS, "levels");

static void *map(const GpuBuffer *buffer, GLbitfield access)
{
    glBindBuffer(GL_SHADER_STORAGE_BUFFER, buffer->buffer);
    return glMapBufferRange(GL_SHADER_STORAGE_BUFFER, 0, (GLsizeiptr)buffer->size, access);
}

static void unmap(const GpuBuffer *buffer)
{
    glBindBuffer(GL_SHADER_STORAGE_BUFFER, buffer->buffer);
    glUnmapBuffer(GL_SHADER_STORAGE_BUFFER);
}

static Result build_hide(Cull *cull, Error *error)
{
    const ShaderDefine defines[] = {{"GROUP_SIZE", cull->limits->sizes.items}, {NULL, 0}};
    return cull->hide ? RESULT_OK
                      : shader_build_compute(&cull->hide, "draw/block_hide.comp", defines, error);
}

static void find_nearest(Cull *cull, const RenderTarget *target)
{
    GLuint count = (GLuint)(cull->tiles[0] * cull->tiles[1]);
    glActiveTexture(GL_TEXTURE0 + BIND_MESH_DEPTH);
    glBindTexture(GL_TEXTURE_2D, target->depth);
    gpu_buffer_bind_storage(&cull->nearest, BIND_HIDING_OUT);
    glUseProgram(cull->hide);
    glUniform2i(0, cull->tiles[0], cull->tiles[1]);
    gpu_dispatch(cull->limits, count, (uint64_t)cull->limits->sizes.items, 1);
    glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
}

static Result spread(Cull *cull, Error *error)
{
    float *levels = map(&cull->levels, GL_MAP_WRITE_BIT | GL_MAP_INVALIDATE_BUFFER_BIT);
    float *nearest = map(&cull->nearest, GL_MAP_READ_BIT | GL_MAP_WRITE_BIT);
    if (nearest && levels) cull_make_levels(nearest, cull->tiles[0], cull->tiles[1], levels);
    if (nearest) unmap(&cull->nearest);
    if (levels) unmap(&cull->levels);
    return nearest && levels ? RESULT_OK
                             : error_set(error, RESULT_FAILED, "what is hidden cannot be found");
}

static Result measure_base(Cull *cull, const RenderTarget *target, Error *error)
{
    cull->tiles[0] = (target->width * target->samples + HIDE_TILE - 1) / HIDE_TILE;
    cull->tiles[1] = (target->height * target->samples + HIDE_TILE - 1) / HIDE_TILE;
    int64_t size = (int64_t)cull->tiles[0] * cull->tiles[1] * (int64_t)sizeof(float);
    TRY(build_hide(cull, error));
    TRY(gpu_buffer_reserve(&cull->nearest, cull->limits, "hidden tiles", size, 0, error));
    TRY(gpu_buffer_reserve(&cull->levels, cull->limits, "hidden levels", size * HIDE_LEVELS,
                           GL_R32F, error));
    find_nearest(cull, target);
    return spread(cull, error);
}

Result cull_begin(Cull *cull, const CullBase *base, bool many, Error *error)
{
    cull->covered = base->target != NULL;
    cull->tries = !cull->off && (many || (cull->covered && base->version != cull->base));
    cull->looked_at = cull->outside = cull->hidden = 0;
    if (cull->tries)
        TRY(gpu_buffer_reserve(&cull->tally, cull->limits, "strands in sight", CULL_TALLY_BYTES, 0,
                               error));
    cull_restart(cull);
    if (!cull->tries || !cull->covered || base->version == cull->base) return RESULT_OK;
    cull->base = 0;
    TRY(measure_base(cull, base->target, error));
    cull->base = base->version;
    return RESULT_OK;
}

static Result build_list(Cull *cull, unsigned variant, Error *error)
{
    const ShaderDefine defines[] = {{"GROUP_SIZE", cull->limits->sizes.strands},
                                    {"HIDING", (variant & CULL_HIDING) != 0},
                                    {"PAINT", (variant & CULL_PAINT) != 0},
                                    {"SMOOTH", (variant & CULL_SMOOTH) != 0},
                                    {NULL, 0}};
    GLuint *list = &cull->list[variant];
    return *list ? RESULT_OK : shader_build_compute(list, "draw/block_cull.comp", defines, error);
}

Result cull_build(Cull *cull, unsigned variant, Error *error)
{
    TRY(variant & CULL_HIDING ? build_hide(cull, error) : RESULT_OK);
    return build_list(cull, variant, error);
}

static Result use(Cull *cull, const HairBatch *batch, bool smooth, Error *error)
{
    bool painted = batch->paint.buffer != 0;
    unsigned variant =
        (cull->covered ? CULL_HIDING : 0) | (painted ? CULL_PAINT : 0) | (smooth ? CULL_SMOOTH : 0);
    TRY(build_list(cull, variant, error));
    glUseProgram(cull->list[variant]);
    if (painted) gpu_buffer_bind_texture(&batch->paint, BIND_PAINT);
    if (!cull->covered) return RESULT_OK;
    gpu_buffer_bind_texture(&cull->levels, BIND_HIDING);
    glUniform2i(0, cull->tiles[0], cull->tiles[1]);
    return RESULT_OK;
}

Result cull_make_room(Cull *cull, uint32_t strands, Error *error)
{
    return gpu_buffer_reserve(&cull->listed, cull->limits, "strands",
                              ((int64_t)strands + HEAD_WORDS) * 4, GL_R32UI, error);
}

void cull_restart(Cull *cull)
{
    cull->looked_at = 0;
    if (cull->tries) gpu_buffer_clear(&cull->tally, 0);
}

void cull_count(Cull *cull, const uint32_t *tally)
{
    cull->hidden = tally ? tally[1] : 0;
    cull->outside = tally ? cull->looked_at - tally[0] - tally[1] : 0;
}

Result cull_list(Cull *cull, const HairBatch *batch, const MaterialParams *part, Error *error)
{
    const GLuint none[HEAD_WORDS] = {0};
    TRY(use(cull, batch, part->smooth_parts > 1, error));
    glBindBuffer(GL_SHADER_STORAGE_BUFFER, cull->listed.buffer);
    glBufferSubData(GL_SHADER_STORAGE_BUFFER, 0, sizeof none, none);
    gpu_buffer_bind_storage(&cull->tally, BIND_TALLY_OUT);
    gpu_buffer_bind_storage(&cull->listed, BIND_LISTED_OUT);
    gpu_dispatch(cull->limits, part->drawn_strands, (uint64_t)cull->limits->sizes.strands, 1);
    glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT | GL_TEXTURE_FETCH_BARRIER_BIT |
                    GL_SHADER_STORAGE_BARRIER_BIT);
    gpu_buffer_bind_texture(&cull->listed, BIND_LISTED);
    cull->looked_at += part->drawn_strands;
    return RESULT_OK;
}

void cull_destroy(Cull *cull)
{
    GpuBuffer *const buffers[] = {&cull->listed, &cull->tally, &cull->nearest, &cull->levels};
    for (int i = 0; i < CULL_VARIANTS; ++i)
        if (cull->list[i]) glDeleteProgram(cull->list[i]);
    if (cull->hide) glDeleteProgram(cull->hide);
    for (int i = 0; i < 4; ++i) gpu_buffer_destroy(buffers[i]);
    *cull = (Cull){.limits = cull->limits};
}
