// SPDX-License-Identifier: MIT
#include "passes/hair_shadow.h"

#include "gpu/gpu_dispatch.h"
#include "gpu/gpu_uniforms.h"

#include <string.h>

enum {
    STRIP = 8,          // divides the side length of a map
    PART_VERTICES = 64, // vertices that one lane processes
    PART_SEGMENTS = 8,
    BOX_WORDS = 6
};

// Which maps a program makes (a macro of the shaders).
enum { FIRSTS = 0, DEEP = 1, COARSE_FIRSTS = 2 };

static Result build(GLuint *program, const char *file, int group, int kind, unsigned variant,
                    Error *error)
{
    const ShaderDefine defines[] = {{"GROUP_SIZE", group},
                                    {"DEEP", kind == DEEP},
                                    {"COARSE", kind == COARSE_FIRSTS},
                                    {"PART_VERTICES", PART_VERTICES},
                                    {"PART_SEGMENTS", PART_SEGMENTS},
                                    {"STRIP", STRIP},
                                    {"PAINT", (variant & CAST_PAINT) != 0},
                                    {"SMOOTH", (variant & CAST_SMOOTH) != 0},
                                    {NULL, 0}};
    return *program ? RESULT_OK : shader_build_compute(program, file, defines, error);
}

unsigned hair_shadow_variant(const ShadowCaster *caster)
{
    return (caster->batch->paint.buffer ? CAST_PAINT : 0) |
           (caster->look->features & LOOK_SMOOTH ? CAST_SMOOTH : 0);
}

Result hair_shadow_build(HairShadow *hair, unsigned variant, Error *error)
{
    const GpuSizes sizes = hair->limits->sizes;
    TRY(build(&hair->bounds, "draw/shadow_bounds.comp", sizes.strands, FIRSTS, 0, error));
    TRY(build(&hair->first[variant], "draw/shadow_splat.comp", sizes.strands,
              hair->deep ? COARSE_FIRSTS : FIRSTS, variant, error));
    if (hair->deep)
        TRY(build(&hair->splat[variant], "draw/shadow_splat.comp", sizes.strands, DEEP, variant,
                  error));
    if (hair->deep)
        TRY(build(&hair->spread, "draw/shadow_spread.comp", sizes.items, DEEP, 0, error));
    if (hair->deep)
        TRY(build(&hair->finish, "draw/shadow_finish.comp", sizes.items, DEEP, 0, error));
    return RESULT_OK;
}

void hair_shadow_create(HairShadow *hair, const GpuLimits *limits, bool deep, int side)
{
    *hair = (HairShadow){.deep = deep, .side = side, .limits = limits};
}

static void destroy_maps(HairShadow *hair)
{
    gpu_buffer_destroy(&hair->firsts);
    gpu_buffer_destroy(&hair->depths);
    gpu_buffer_destroy(&hair->sums);
    gpu_buffer_destroy(&hair->layers);
    hair->maps = 0;
}

static void destroy_programs(const GLuint *programs, int count)
{
    for (int i = 0; i < count; ++i) shader_release(programs[i]);
}

void hair_shadow_destroy(HairShadow *hair)
{
    destroy_programs(&hair->bounds, 1);
    destroy_programs(hair->first, CAST_VARIANTS);
    destroy_programs(hair->splat, CAST_VARIANTS);
    destroy_programs(&hair->spread, 1);
    destroy_programs(&hair->finish, 1);
    destroy_maps(hair);
    gpu_buffer_destroy(&hair->box);
    *hair = (HairShadow){0};
}

// Buffers that other passes read later.
static Result make_maps(HairShadow *hair, int maps, Error *error)
{
    if (hair->maps < maps) {
        destroy_maps(hair);
        hair->maps = maps;
    }
    int64_t texels = (int64_t)hair->maps * hair->side * hair->side;
    if (!hair->deep)
        return gpu_buffer_reserve(&hair->firsts, hair->limits, "shadow's depths", 4 * texels,
                                  GL_R32UI, error);
    TRY(gpu_buffer_reserve(&hair->depths, hair->limits, "starts of shadow layers", 4 * texels,
                           GL_R32F, error));
    return gpu_buffer_reserve(&hair->layers, hair->limits, "shadow's layers",
                              4 * texels * SHADOW_LAYERS, GL_R32UI, error);
}

// Buffers that are only used while maps are made.
static Result make_scratch(HairShadow *hair, ShadowCasters casters, Error *error)
{
    int64_t texels = (int64_t)hair->maps * hair->side * hair->side;
    TRY(gpu_buffer_reserve(&hair->box, hair->limits, "box of hair by light",
                           4 * MAX_LIGHTS * BOX_WORDS, 0, error));
    if (hair->deep)
        TRY(gpu_buffer_reserve(&hair->firsts, hair->limits, "shadow's depths",
                               4 * texels / (SHADOW_COARSE * SHADOW_COARSE), GL_R32UI, error));
    if (hair->deep)
        TRY(gpu_buffer_reserve(&hair->sums, hair->limits, "shadow's sums",
                               4 * texels * SHADOW_LAYERS, GL_R32UI, error));
    for (uint32_t i = 0; i < casters.count; ++i)
        TRY(hair_shadow_build(hair, hair_shadow_variant(&casters.list[i]), error));
    return RESULT_OK;
}

Result hair_shadow_begin(HairShadow *hair, int maps, ShadowCasters casters, Error *error)
{
    TRY(make_maps(hair, maps, error));
    TRY(make_scratch(hair, casters, error));
    gpu_buffer_clear(&hair->firsts, SHADOW_DEPTHS);
    if (hair->deep) gpu_buffer_clear(&hair->sums, 0);
    return RESULT_OK;
}

// Runs a pass over all ribbons. A lane processes `part` points of a strand. `programs` has
// CAST_VARIANTS programs; if it is NULL, the program for bounding boxes runs on all particles.
static void cast(HairShadow *hair, ShadowCasters casters, const CastParams *params,
                 const GLuint *programs, uint32_t part)
{
    gpu_uniforms_set(BIND_CAST, params, sizeof *params);
    for (uint32_t i = 0; i < casters.count; ++i) {
        const ShadowCaster *caster = &casters.list[i];
        const HairBatch *batch = caster->batch;
        MaterialParams material = look_material(caster->look, batch);
        uint32_t points = programs ? look_points(caster->look, batch) : batch->vertex_count;
        glUseProgram(programs ? programs[hair_shadow_variant(caster)] : hair->bounds);
        gpu_uniforms_set(BIND_MATERIAL, &material, sizeof material);
        gpu_buffer_bind_texture(&batch->position, BIND_POSITION);
        if (batch->paint.buffer) gpu_buffer_bind_texture(&batch->paint, BIND_PAINT);
        gpu_dispatch(hair->limits, material.drawn_strands, (uint64_t)hair->limits->sizes.strands,
                     (points + part - 1) / part);
    }
    glMemoryBarrier(GL_TEXTURE_FETCH_BARRIER_BIT | GL_SHADER_STORAGE_BARRIER_BIT |
                    GL_BUFFER_UPDATE_BARRIER_BIT);
}

float hair_shadow_unordered(int32_t bits)
{
    float value;
    bits = bits < 0 ? bits ^ 0x7fffffff : bits;
    memcpy(&value, &bits, sizeof value);
    return value;
}

static void find_boxes(HairShadow *hair, const ShadowFrames *frames, ShadowCasters casters,
                       double (*boxes)[6])
{
    GLint words[MAX_LIGHTS][BOX_WORDS] = {0};
    int count = frames->count;
    int64_t size = (int64_t)((size_t)count * sizeof *words);
    for (int i = 0; i < count; ++i)
        for (int k = 0; k < BOX_WORDS; ++k) words[i][k] = k < 3 ? INT32_MAX : INT32_MIN;
    gpu_buffer_write(&hair->box, 0, words, size);
    gpu_buffer_bind_storage(&hair->box, BIND_BOUNDS_OUT);
    for (int i = 0; i < count; ++i) {
        CastParams params = shadow_frames_box(frames, i);
        cast(hair, casters, &params, NULL, PART_VERTICES);
    }
    glBindBuffer(GL_SHADER_STORAGE_BUFFER, hair->box.buffer);
    glGetBufferSubData(GL_SHADER_STORAGE_BUFFER, 0, (GLsizeiptr)size, words);
    for (int i = 0; i < count; ++i)
        for (int k = 0; k < BOX_WORDS; ++k)
            boxes[i][k] = (double)hair_shadow_unordered(words[i][k]);
}

void hair_shadow_find_boxes(HairShadow *hair, const ShadowFrames *frames, ShadowCasters casters,
                            double (*boxes)[6])
{
    if (frames->count) find_boxes(hair, frames, casters, boxes);
}

// Draws first depths to texels that are `coarse` texels of the map wide.
static void draw_firsts(HairShadow *hair, ShadowCasters casters, const CastParams *params,
                        int coarse)
{
    CastParams wide = *params;
    wide.side /= coarse;
    wide.texels /= (float)coarse;
    for (int k = 0; k < 2; ++k)
        for (int i = 0; i < 4; ++i) wide.from_world[k][i] /= (float)coarse;
    gpu_buffer_bind_storage(&hair->firsts, BIND_FIRST_OUT);
    cast(hair, casters, &wide, hair->first, PART_SEGMENTS);
}

static void run_texels(const HairShadow *hair, const CastParams *params, GLuint program, int lanes)
{
    glUseProgram(program);
    glUniform2i(0, params->side, params->map);
    gpu_dispatch(hair->limits, (uint64_t)lanes, (uint64_t)hair->limits->sizes.items, 1);
    glMemoryBarrier(GL_TEXTURE_FETCH_BARRIER_BIT);
}

static void spread(const HairShadow *hair, const CastParams *params)
{
    int corners = params->side / SHADOW_COARSE + 1;
    run_texels(hair, params, hair->spread, corners * corners);
}

static void finish(const HairShadow *hair, const CastParams *params)
{
    glUseProgram(hair->finish);
    glUniform1f(1, params->unit);
    run_texels(hair, params, hair->finish, params->side * params->side / STRIP);
}

static void draw_deep(HairShadow *hair, ShadowCasters casters, const CastParams *params)
{
    draw_firsts(hair, casters, params, SHADOW_COARSE);
    gpu_buffer_bind_texture(&hair->firsts, BIND_FIRST);
    gpu_buffer_bind_storage(&hair->depths, BIND_DEPTHS_OUT);
    spread(hair, params);
    gpu_buffer_bind_texture(&hair->depths, BIND_DEPTHS);
    gpu_buffer_bind_storage(&hair->sums, BIND_SUMS_OUT);
    cast(hair, casters, params, hair->splat, PART_SEGMENTS);
    gpu_buffer_bind_texture(&hair->sums, BIND_SUMS);
    gpu_buffer_bind_storage(&hair->layers, BIND_LAYERS_OUT);
    finish(hair, params);
}

void hair_shadow_draw(HairShadow *hair, const ShadowFrames *frames, int map, ShadowCasters casters)
{
    const CastParams *params = &frames->casts[map];
    if (hair->deep)
        draw_deep(hair, casters, params);
    else
        draw_firsts(hair, casters, params, 1);
}

void hair_shadow_bind(const HairShadow *hair)
{
    if (hair->deep) gpu_buffer_bind_texture(&hair->depths, BIND_DEPTHS);
    gpu_buffer_bind_texture(hair->deep ? &hair->layers : &hair->firsts, BIND_LAYERS);
}
