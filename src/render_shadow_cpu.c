// SPDX-License-Identifier: MIT
#include "render_shadow_cpu.h"

#include <stdlib.h>

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

void render_shadow_cpu_destroy(RenderShadowCpu *cpu)
{
    cpu_shadow_destroy(&cpu->shadow);
    free(cpu->casters);
    free(cpu->mapped);
    *cpu = (RenderShadowCpu){0};
}

static Result make_room(RenderShadowCpu *cpu, uint32_t count, Error *error)
{
    if (cpu->mapped && count <= cpu->room) return RESULT_OK;
    free(cpu->casters);
    free(cpu->mapped);
    cpu->room = count;
    cpu->casters = malloc((count + 1) * sizeof *cpu->casters);
    cpu->mapped = malloc((2 * (size_t)count + 2) * sizeof *cpu->mapped);
    if (cpu->casters && cpu->mapped) return RESULT_OK;
    return error_set(error, RESULT_FAILED, "no memory for %u batches", count);
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

Result render_shadow_cpu_begin(RenderShadowCpu *cpu, ShadowCasters casters, const GpuBuffer *depths,
                               const GpuBuffer *texels, Error *error)
{
    const GLbitfield write = GL_MAP_WRITE_BIT | GL_MAP_INVALIDATE_BUFFER_BIT;
    Result result = make_room(cpu, casters.count, error);
    if (result != RESULT_OK) return result;
    glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
    cpu->count = cpu->mapped_count = 0;
    bool mapped = true;
    for (uint32_t i = 0; i < casters.count && mapped; ++i)
        mapped = open_caster(cpu, &casters.list[i]);
    cpu->depths = cpu->shadow.deep && mapped ? map(cpu, depths, write) : NULL;
    cpu->texels = mapped ? map(cpu, texels, write) : NULL;
    if (cpu->texels && (cpu->depths || !cpu->shadow.deep)) return RESULT_OK;
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

void render_shadow_cpu_draw(RenderShadowCpu *cpu, const CastParams *params)
{
    size_t texels = (size_t)cpu->shadow.side * (size_t)cpu->shadow.side, map = (size_t)params->map;
    if (cpu->shadow.deep)
        cpu_shadow_draw_deep(&cpu->shadow, params, casters_of(cpu), cpu->depths + map * texels,
                             cpu->texels + map * SHADOW_LAYERS * texels);
    else
        cpu_shadow_draw_firsts(&cpu->shadow, params, casters_of(cpu), cpu->texels + map * texels);
}
