// SPDX-License-Identifier: MIT
#include "draw/render_shadow_cpu.h"

#include "draw/cpu_shadow_light.h"

#include <stdlib.h>

static const GLbitfield WRITTEN = GL_MAP_WRITE_BIT | GL_MAP_INVALIDATE_BUFFER_BIT;

bool render_shadow_cpu_can(ShadowCasters casters)
{
    bool plain = true;
    for (uint32_t i = 0; i < casters.count; ++i)
        plain = plain && !(casters.list[i].look.features & LOOK_SMOOTH);
    return plain;
}

Result render_shadow_cpu_create(RenderShadowCpu *cpu, int side, bool deep, Error *error)
{
    *cpu = (RenderShadowCpu){0};
    return cpu_shadow_create(&cpu->shadow, side, deep, error);
}

static void forget_lights(RenderShadowCpu *cpu)
{
    for (uint32_t i = 0; i < cpu->room; ++i) gpu_buffer_destroy(&cpu->lights[i].left);
    cpu->lit = 0;
}

void render_shadow_cpu_destroy(RenderShadowCpu *cpu)
{
    forget_lights(cpu);
    cpu_shadow_destroy(&cpu->shadow);
    free(cpu->casters);
    free(cpu->lights);
    free(cpu->left);
    free(cpu->mapped);
    *cpu = (RenderShadowCpu){0};
}

static Result make_room(RenderShadowCpu *cpu, uint32_t count, Error *error)
{
    if (cpu->mapped && count <= cpu->room) return RESULT_OK;
    forget_lights(cpu);
    free(cpu->casters);
    free(cpu->lights);
    free(cpu->left);
    free(cpu->mapped);
    cpu->room = 0;
    cpu->casters = malloc((count + 1) * sizeof *cpu->casters);
    cpu->lights = calloc(count + 1, sizeof *cpu->lights);
    cpu->left = malloc((count + 1) * sizeof *cpu->left);
    cpu->mapped = malloc((3 * (size_t)count + 2) * sizeof *cpu->mapped);
    if (!cpu->casters || !cpu->lights || !cpu->left || !cpu->mapped)
        return error_set(error, RESULT_FAILED, "no memory for %u batches", count);
    cpu->room = count;
    return RESULT_OK;
}

// Room for what is left at each particle, if a shader can see so much.
static Result make_lights(RenderShadowCpu *cpu, const GpuLimits *limits, int maps,
                          ShadowCasters casters, Error *error)
{
    Result result = RESULT_OK;
    cpu->lit = cpu->shadow.deep ? casters.count : 0;
    for (uint32_t i = 0; i < cpu->lit && result == RESULT_OK; ++i) {
        const HairBatch *batch = casters.list[i].batch;
        GpuBuffer *left = &cpu->lights[i].left;
        int64_t floats = (int64_t)maps * hair_slots(batch) * batch->vertex_count;
        if (floats > limits->texture_texels || floats * 4 > limits->storage_block) {
            forget_lights(cpu);
            return result;
        }
        cpu->lights[i].batch = batch;
        if (left->size == floats * 4) continue;
        gpu_buffer_destroy(left);
        result = gpu_buffer_create(left, limits, "light on hair", floats * 4, NULL, GL_R32F, error);
    }
    return result;
}

// NULL on failure.
static void *map(RenderShadowCpu *cpu, const GpuBuffer *buffer, GLbitfield access)
{
    glBindBuffer(GL_SHADER_STORAGE_BUFFER, buffer->buffer);
    void *data = glMapBufferRange(GL_SHADER_STORAGE_BUFFER, 0, (GLsizeiptr)buffer->size, access);
    if (data) cpu->mapped[cpu->mapped_count++] = buffer->buffer;
    return data;
}

static bool open_caster(RenderShadowCpu *cpu, const ShadowCaster *caster)
{
    const HairBatch *batch = caster->batch;
    CpuCaster *mine = &cpu->casters[cpu->count++];
    *mine = (CpuCaster){.material = look_material(&caster->look, batch),
                        .position = map(cpu, &batch->position, GL_MAP_READ_BIT)};
    if (batch->paint.buffer) mine->paint = map(cpu, &batch->paint, GL_MAP_READ_BIT);
    return mine->position && (mine->paint || !batch->paint.buffer);
}

static bool open_light(RenderShadowCpu *cpu, uint32_t i)
{
    cpu->left[i] = map(cpu, &cpu->lights[i].left, WRITTEN);
    return cpu->left[i] != NULL;
}

static bool open_all(RenderShadowCpu *cpu, ShadowCasters casters, const GpuBuffer *depths,
                     const GpuBuffer *texels)
{
    bool open = true;
    cpu->count = cpu->mapped_count = 0;
    for (uint32_t i = 0; i < casters.count && open; ++i)
        open = open_caster(cpu, &casters.list[i]) && (i >= cpu->lit || open_light(cpu, i));
    if (open && cpu->shadow.deep) open = (cpu->depths = map(cpu, depths, WRITTEN)) != NULL;
    // Layers are read where light is found at particles.
    if (open) cpu->texels = map(cpu, texels, GL_MAP_READ_BIT | GL_MAP_WRITE_BIT);
    return open && cpu->texels;
}

Result render_shadow_cpu_begin(RenderShadowCpu *cpu, const GpuLimits *limits, int maps,
                               ShadowCasters casters, const GpuBuffer *depths,
                               const GpuBuffer *texels, Error *error)
{
    Result result = make_room(cpu, casters.count, error);
    if (result == RESULT_OK) result = make_lights(cpu, limits, maps, casters, error);
    if (result != RESULT_OK) return result;
    glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
    if (open_all(cpu, casters, depths, texels)) return RESULT_OK;
    render_shadow_cpu_end(cpu);
    return error_set(error, RESULT_FAILED, "hair's positions cannot be read for its shadows");
}

void render_shadow_cpu_end(RenderShadowCpu *cpu)
{
    while (cpu->mapped_count) {
        glBindBuffer(GL_SHADER_STORAGE_BUFFER, cpu->mapped[--cpu->mapped_count]);
        glUnmapBuffer(GL_SHADER_STORAGE_BUFFER);
    }
}

static CpuCasters casters_of(const RenderShadowCpu *cpu)
{
    return (CpuCasters){cpu->casters, cpu->count};
}

bool render_shadow_cpu_find_box(RenderShadowCpu *cpu, const CastParams *params, double box[6])
{
    return cpu_shadow_find_box(&cpu->shadow, params, casters_of(cpu), box);
}

static void draw_deep(RenderShadowCpu *cpu, const CastParams *params, float across)
{
    size_t texels = (size_t)cpu->shadow.side * (size_t)cpu->shadow.side, map = (size_t)params->map;
    uint32_t *layers = cpu->texels + map * SHADOW_LAYERS * texels;
    cpu_shadow_draw_deep(&cpu->shadow, params, casters_of(cpu), cpu->depths + map * texels, layers);
    for (uint32_t i = 0; i < cpu->lit; ++i) {
        size_t particles = hair_slots(cpu->lights[i].batch) * cpu->lights[i].batch->vertex_count;
        cpu_shadow_find_light(&cpu->shadow, params, &cpu->casters[i], across, layers,
                              cpu->left[i] + map * particles);
    }
}

void render_shadow_cpu_draw(RenderShadowCpu *cpu, const CastParams *params, float across)
{
    size_t texels = (size_t)cpu->shadow.side * (size_t)cpu->shadow.side, map = (size_t)params->map;
    if (cpu->shadow.deep)
        draw_deep(cpu, params, across);
    else
        cpu_shadow_draw_firsts(&cpu->shadow, params, casters_of(cpu), cpu->texels + map * texels);
}
