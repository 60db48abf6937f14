// SPDX-License-Identifier: MIT
#include "passes/cull.h"

#include "gpu/gpu_dispatch.h"

#include "glsl/draw/draw.h"

enum { HEAD_WORDS = 1 }; // words of `listed` before the rows

static Result build_hide(Cull *cull, Error *error)
{
    const ShaderDefine defines[] = {{"GROUP_SIZE", cull->limits->sizes.items}, {NULL, 0}};
    if (!cull->hide) TRY(shader_build_compute(&cull->hide, "draw/block_hide.comp", defines, error));
    return cull->spread
               ? RESULT_OK
               : shader_build_compute(&cull->spread, "draw/block_level.comp", defines, error);
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
    glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT);
}

Result cull_make_levels(Cull *cull, Error *error)
{
    TRY(build_hide(cull, error));
    gpu_buffer_bind_storage(&cull->nearest, BIND_HIDING_OUT);
    gpu_buffer_bind_storage(&cull->levels, BIND_LEVELS_OUT);
    glUseProgram(cull->spread);
    glUniform2i(0, cull->tiles[0], cull->tiles[1]);
    for (int level = 0; level < HIDE_LEVELS; ++level) {
        uint64_t columns = (uint64_t)((cull->tiles[0] - 1) >> level) + 1,
                 rows = (uint64_t)((cull->tiles[1] - 1) >> level) + 1;
        glUniform1i(1, level);
        gpu_dispatch(cull->limits, columns * rows, (uint64_t)cull->limits->sizes.items, 1);
        glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT | GL_TEXTURE_FETCH_BARRIER_BIT);
    }
    return RESULT_OK;
}

static Result measure_base(Cull *cull, const RenderTarget *target, Error *error)
{
    cull->tiles[0] = (target->width * target->samples + HIDE_TILE - 1) / HIDE_TILE;
    cull->tiles[1] = (target->height * target->samples + HIDE_TILE - 1) / HIDE_TILE;
    int64_t size = (int64_t)cull->tiles[0] * cull->tiles[1] * (int64_t)sizeof(float);
    TRY(build_hide(cull, error));
    TRY(gpu_buffer_reserve(&cull->nearest, cull->limits, "hidden tiles", size * HIDE_LEVELS, 0,
                           error));
    TRY(gpu_buffer_reserve(&cull->levels, cull->limits, "hidden levels", size * HIDE_LEVELS,
                           GL_R32F, error));
    find_nearest(cull, target);
    return cull_make_levels(cull, error);
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
    gpu_buffer_write(&cull->listed, 0, none, sizeof none);
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
    for (int i = 0; i < CULL_VARIANTS; ++i) shader_release(cull->list[i]);
    shader_release(cull->hide);
    shader_release(cull->spread);
    for (int i = 0; i < 4; ++i) gpu_buffer_destroy(buffers[i]);
    *cull = (Cull){.limits = cull->limits};
}
