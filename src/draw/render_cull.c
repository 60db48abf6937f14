// SPDX-License-Identifier: MIT
#include "draw/render_cull.h"

#include "draw/hide_levels.h"

#include "glsl/draw/draw.h"

enum { GROUP = 8, HEAD_WORDS = 2 }; // of `listed`, before the rows

_Static_assert((int)HIDE_LEVEL_COUNT == HIDE_LEVELS, "levels");

static Result make_room(GpuBuffer *buffer, const GpuLimits *limits, const char *what, int64_t size,
                        GLenum format, Error *error)
{
    if (buffer->size >= size) return RESULT_OK;
    gpu_buffer_destroy(buffer);
    return gpu_buffer_create(buffer, limits, what, size, NULL, format, error);
}

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

static Result build_hide(RenderCull *cull, Error *error)
{
    const ShaderDefine defines[] = {{"GROUP_SIZE", GROUP}, {NULL, 0}};
    return cull->hide ? RESULT_OK
                      : shader_build_compute(&cull->hide, "draw/block_hide.comp", defines, error);
}

static void find_nearest(RenderCull *cull, const RenderTarget *target)
{
    GLuint count = (GLuint)(cull->tiles[0] * cull->tiles[1]);
    glActiveTexture(GL_TEXTURE0 + BIND_MESH_DEPTH);
    glBindTexture(GL_TEXTURE_2D, target->depth);
    gpu_buffer_bind_storage(&cull->nearest, BIND_HIDING_OUT);
    glUseProgram(cull->hide);
    glUniform2i(0, cull->tiles[0], cull->tiles[1]);
    glDispatchCompute((count + GROUP - 1) / GROUP, 1, 1);
    glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
}

static Result spread(RenderCull *cull, Error *error)
{
    float *levels = map(&cull->levels, GL_MAP_WRITE_BIT | GL_MAP_INVALIDATE_BUFFER_BIT);
    float *nearest = map(&cull->nearest, GL_MAP_READ_BIT | GL_MAP_WRITE_BIT);
    if (nearest && levels) hide_levels_make(nearest, cull->tiles[0], cull->tiles[1], levels);
    if (nearest) unmap(&cull->nearest);
    if (levels) unmap(&cull->levels);
    return nearest && levels ? RESULT_OK
                             : error_set(error, RESULT_FAILED, "what is hidden cannot be found");
}

static Result measure_base(RenderCull *cull, const GpuLimits *limits, const RenderTarget *target,
                           Error *error)
{
    cull->tiles[0] = (target->width * target->samples + HIDE_TILE - 1) / HIDE_TILE;
    cull->tiles[1] = (target->height * target->samples + HIDE_TILE - 1) / HIDE_TILE;
    int64_t size = (int64_t)cull->tiles[0] * cull->tiles[1] * (int64_t)sizeof(float);
    Result result = build_hide(cull, error);
    if (result == RESULT_OK)
        result = make_room(&cull->nearest, limits, "hidden tiles", size, 0, error);
    if (result == RESULT_OK)
        result =
            make_room(&cull->levels, limits, "hidden levels", size * HIDE_LEVELS, GL_R32F, error);
    if (result != RESULT_OK) return result;
    find_nearest(cull, target);
    return spread(cull, error);
}

Result render_cull_begin(RenderCull *cull, const GpuLimits *limits, const CullBase *base, bool many,
                         Error *error)
{
    cull->covered = base->target != NULL;
    cull->tries = !cull->off && (many || (cull->covered && base->version != cull->base));
    cull->outside = cull->hidden = 0;
    if (!cull->tries || !cull->covered || base->version == cull->base) return RESULT_OK;
    cull->base = 0;
    Result result = measure_base(cull, limits, base->target, error);
    if (result == RESULT_OK) cull->base = base->version;
    return result;
}

static Result build_list(RenderCull *cull, unsigned variant, Error *error)
{
    const ShaderDefine defines[] = {{"GROUP_SIZE", GROUP},
                                    {"HIDING", (variant & CULL_HIDING) != 0},
                                    {"PAINT", (variant & CULL_PAINT) != 0},
                                    {"SMOOTH", (variant & CULL_SMOOTH) != 0},
                                    {NULL, 0}};
    GLuint *list = &cull->list[variant];
    return *list ? RESULT_OK : shader_build_compute(list, "draw/block_cull.comp", defines, error);
}

Result render_cull_build(RenderCull *cull, unsigned variant, Error *error)
{
    Result result = variant & CULL_HIDING ? build_hide(cull, error) : RESULT_OK;
    return result == RESULT_OK ? build_list(cull, variant, error) : result;
}

static Result use(RenderCull *cull, const HairBatch *batch, bool smooth, Error *error)
{
    bool painted = batch->paint.buffer != 0;
    unsigned variant =
        (cull->covered ? CULL_HIDING : 0) | (painted ? CULL_PAINT : 0) | (smooth ? CULL_SMOOTH : 0);
    Result result = build_list(cull, variant, error);
    if (result != RESULT_OK) return result;
    glUseProgram(cull->list[variant]);
    if (painted) gpu_buffer_bind_texture(&batch->paint, BIND_PAINT);
    if (!cull->covered) return RESULT_OK;
    gpu_buffer_bind_texture(&cull->levels, BIND_HIDING);
    glUniform2i(0, cull->tiles[0], cull->tiles[1]);
    return RESULT_OK;
}

Result render_cull_make_room(RenderCull *cull, const GpuLimits *limits, uint32_t strands,
                             Error *error)
{
    return make_room(&cull->listed, limits, "strands", ((int64_t)strands + HEAD_WORDS) * 4,
                     GL_R32UI, error);
}

Result render_cull_list(RenderCull *cull, const HairBatch *batch, const MaterialParams *part,
                        uint32_t *count, Error *error)
{
    GLuint found[HEAD_WORDS] = {0};
    Result result = use(cull, batch, part->smooth_parts > 1, error);
    if (result != RESULT_OK) return result;
    glBindBuffer(GL_SHADER_STORAGE_BUFFER, cull->listed.buffer);
    glBufferSubData(GL_SHADER_STORAGE_BUFFER, 0, sizeof found, found);
    gpu_buffer_bind_storage(&cull->listed, BIND_LISTED_OUT);
    glDispatchCompute((part->drawn_strands + GROUP - 1) / GROUP, 1, 1);
    glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT | GL_TEXTURE_FETCH_BARRIER_BIT);
    glGetBufferSubData(GL_SHADER_STORAGE_BUFFER, 0, sizeof found, found);
    gpu_buffer_bind_texture(&cull->listed, BIND_LISTED);
    *count = found[0];
    cull->hidden += found[1];
    cull->outside += part->drawn_strands - found[0] - found[1];
    return RESULT_OK;
}

void render_cull_destroy(RenderCull *cull)
{
    GpuBuffer *const buffers[] = {&cull->listed, &cull->nearest, &cull->levels};
    for (int i = 0; i < CULL_VARIANTS; ++i)
        if (cull->list[i]) glDeleteProgram(cull->list[i]);
    if (cull->hide) glDeleteProgram(cull->hide);
    for (int i = 0; i < 3; ++i) gpu_buffer_destroy(buffers[i]);
    *cull = (RenderCull){0};
}
