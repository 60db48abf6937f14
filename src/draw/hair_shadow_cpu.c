// SPDX-License-Identifier: MIT
#include "draw/hair_shadow_cpu.h"

#include "lanes/shadow_light.h"

#include <stdlib.h>

static const GLbitfield WRITTEN = GL_MAP_WRITE_BIT | GL_MAP_INVALIDATE_BUFFER_BIT;

Result hair_shadow_cpu_create(HairShadowCpu *cpu, int side, bool deep, bool behind, Error *error)
{
    *cpu = (HairShadowCpu){.behind = behind};
    return shadow_map_create(&cpu->map, side, deep, error);
}

// Positions, paint and light of each batch, without and with the mesh, a map's two parts and the
// mesh's maps.
static size_t count_buffers(uint32_t batches)
{
    return 4 * (size_t)batches + 3;
}

static void forget_room(HairShadowCpu *cpu)
{
    for (uint32_t i = 0; i < cpu->room; ++i) {
        gpu_buffer_destroy(&cpu->lights[i].left);
        gpu_buffer_destroy(&cpu->reaching[i].left);
    }
    for (size_t i = 0; cpu->mapped && i < count_buffers(cpu->room); ++i) free(cpu->mapped[i].copy);
    free(cpu->casters);
    free(cpu->lights);
    free(cpu->reaching);
    free(cpu->left);
    free(cpu->mapped);
    cpu->casters = NULL, cpu->lights = cpu->reaching = NULL, cpu->left = NULL, cpu->mapped = NULL;
    cpu->room = cpu->lit = 0;
}

void hair_shadow_cpu_destroy(HairShadowCpu *cpu)
{
    shadow_map_destroy(&cpu->map);
    shadow_points_destroy(&cpu->points);
    shadow_past_destroy(&cpu->past);
    tile_order_destroy(&cpu->order);
    forget_room(cpu);
}

static Result make_room(HairShadowCpu *cpu, uint32_t count, Error *error)
{
    if (cpu->mapped && count <= cpu->room) return RESULT_OK;
    forget_room(cpu);
    cpu->casters = malloc((count + 1) * sizeof *cpu->casters);
    cpu->lights = calloc(count + 1, sizeof *cpu->lights);
    cpu->reaching = calloc(count + 1, sizeof *cpu->reaching);
    cpu->left = malloc((count + 1) * sizeof *cpu->left);
    cpu->mapped = calloc(count_buffers(count), sizeof *cpu->mapped);
    if (cpu->lights && cpu->reaching && cpu->mapped) cpu->room = count;
    if (cpu->casters && cpu->left && cpu->room == count) return RESULT_OK;
    forget_room(cpu);
    return error_set(error, RESULT_FAILED, "no memory for %u batches", count);
}

static int64_t count_floats(const ShadowCaster *caster)
{
    return (int64_t)hair_slots(caster->batch) * look_points(&caster->look, caster->batch);
}

static Result make_light(ParticleLight *light, const ShadowCaster *caster, const GpuLimits *limits,
                         int64_t size, Error *error)
{
    light->batch = caster->batch;
    if (light->left.size == size) return RESULT_OK;
    gpu_buffer_destroy(&light->left);
    return gpu_buffer_create(&light->left, limits, "light on hair", size, NULL, GL_R32F, error);
}

// Room for what is left at each point, if a shader can see so much.
static Result make_lights(HairShadowCpu *cpu, const GpuLimits *limits, int maps,
                          ShadowCasters casters, Error *error)
{
    cpu->lit = 0;
    cpu->maps = maps;
    for (uint32_t i = 0; i < casters.count && cpu->map.deep; ++i) {
        int64_t floats = maps * (1 + cpu->behind) * count_floats(&casters.list[i]);
        if (floats > limits->texture_texels || floats * 4 > limits->storage_block) return RESULT_OK;
    }
    for (uint32_t i = 0; i < casters.count && cpu->map.deep; ++i) {
        int64_t size = maps * count_floats(&casters.list[i]) * 4;
        TRY(make_light(&cpu->lights[i], &casters.list[i], limits, size * (1 + cpu->behind), error));
        if (cpu->past_mesh)
            TRY(make_light(&cpu->reaching[i], &casters.list[i], limits, size, error));
    }
    if (cpu->map.deep) cpu->lit = casters.count;
    return RESULT_OK;
}

// Of what is written the content is undefined.
static void *copy(SharedBuffer *shared, const GpuBuffer *buffer)
{
    if (shared->room < buffer->size) {
        free(shared->copy);
        shared->copy = malloc((size_t)buffer->size);
        shared->room = shared->copy ? buffer->size : 0;
    }
    if (shared->copy && !shared->written)
        glGetBufferSubData(GL_SHADER_STORAGE_BUFFER, 0, (GLsizeiptr)buffer->size, shared->copy);
    return shared->copy;
}

// NULL on failure.
static void *map(HairShadowCpu *cpu, const GpuBuffer *buffer, GLbitfield access)
{
    SharedBuffer *shared = &cpu->mapped[cpu->mapped_count];
    shared->buffer = buffer->buffer;
    shared->size = buffer->size;
    shared->written = access & GL_MAP_WRITE_BIT;
    glBindBuffer(GL_SHADER_STORAGE_BUFFER, buffer->buffer);
    void *data = cpu->copies ? copy(shared, buffer)
                             : glMapBufferRange(GL_SHADER_STORAGE_BUFFER, 0,
                                                (GLsizeiptr)buffer->size, access);
    if (data) ++cpu->mapped_count;
    return data;
}

static bool map_caster(HairShadowCpu *cpu, const ShadowCaster *caster, uint32_t i)
{
    const HairBatch *batch = caster->batch;
    MappedCaster *mine = &cpu->casters[cpu->count++];
    *mine = (MappedCaster){.material = look_material(&caster->look, batch),
                           .position = map(cpu, &batch->position, GL_MAP_READ_BIT)};
    if (batch->paint.buffer) mine->paint = map(cpu, &batch->paint, GL_MAP_READ_BIT);
    GLbitfield access = cpu->past_mesh ? GL_MAP_READ_BIT | GL_MAP_WRITE_BIT : WRITTEN;
    if (i < cpu->lit) cpu->left[i] = map(cpu, &cpu->lights[i].left, access);
    return mine->position && (mine->paint || !batch->paint.buffer) &&
           (i >= cpu->lit || cpu->left[i]);
}

static bool map_all(HairShadowCpu *cpu, ShadowCasters casters, const GpuBuffer *depths,
                    const GpuBuffer *texels)
{
    bool good = true;
    cpu->count = cpu->mapped_count = 0;
    for (uint32_t i = 0; i < casters.count && good; ++i)
        good = map_caster(cpu, &casters.list[i], i);
    if (good && cpu->map.deep) good = (cpu->depths = map(cpu, depths, WRITTEN)) != NULL;
    // Layers are read where light is found at points.
    if (good) cpu->texels = map(cpu, texels, GL_MAP_READ_BIT | GL_MAP_WRITE_BIT);
    return good && cpu->texels;
}

Result hair_shadow_cpu_begin(HairShadowCpu *cpu, const GpuLimits *limits, int maps,
                             ShadowCasters casters, const GpuBuffer *depths,
                             const GpuBuffer *texels, Error *error)
{
    TRY(make_room(cpu, casters.count, error));
    TRY(make_lights(cpu, limits, maps, casters, error));
    glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
    if (map_all(cpu, casters, depths, texels)) {
        tile_order_find(&cpu->order, cpu->casters, cpu->count);
        shadow_points_find(&cpu->points, cpu->casters, cpu->count, cpu->map.parts);
        return RESULT_OK;
    }
    hair_shadow_cpu_end(cpu);
    return error_set(error, RESULT_FAILED, "cannot read hair's positions for its shadows");
}

void hair_shadow_cpu_end(HairShadowCpu *cpu)
{
    while (cpu->mapped_count) {
        const SharedBuffer *shared = &cpu->mapped[--cpu->mapped_count];
        glBindBuffer(GL_SHADER_STORAGE_BUFFER, shared->buffer);
        if (!cpu->copies)
            glUnmapBuffer(GL_SHADER_STORAGE_BUFFER);
        else if (shared->written)
            glBufferSubData(GL_SHADER_STORAGE_BUFFER, 0, (GLsizeiptr)shared->size, shared->copy);
    }
}

static MappedCasters casters_of(const HairShadowCpu *cpu)
{
    return (MappedCasters){cpu->casters, cpu->count};
}

bool hair_shadow_cpu_find_box(HairShadowCpu *cpu, const CastParams *params, double box[6])
{
    return shadow_map_find_box(&cpu->map, params, casters_of(cpu), box);
}

void hair_shadow_cpu_draw(HairShadowCpu *cpu, const CastParams *params, float across)
{
    size_t texels = (size_t)cpu->map.side * (size_t)cpu->map.side, number = (size_t)params->map;
    uint32_t *layers = cpu->texels + number * (cpu->map.deep ? SHADOW_LAYERS : 1) * texels;
    if (!cpu->map.deep) {
        shadow_map_draw_firsts(&cpu->map, params, casters_of(cpu), layers);
        return;
    }
    shadow_map_draw_deep(&cpu->map, params, casters_of(cpu), cpu->depths + number * texels, layers);
    for (uint32_t i = 0; i < cpu->lit; ++i) {
        size_t points =
            hair_slots(cpu->lights[i].batch) * (size_t)mapped_caster_points(&cpu->casters[i]);
        float *left = cpu->left[i] + number * points;
        shadow_light_find(&cpu->map, params, &cpu->casters[i], across, layers, left,
                          cpu->behind ? left + (size_t)cpu->maps * points : NULL);
    }
}

static Result pass_mesh(HairShadowCpu *cpu, const ShadowParams *params, const float *depths,
                        Error *error)
{
    if (!cpu->bounded) TRY(shadow_past_begin(&cpu->past, params, depths, cpu->map.parts, error));
    cpu->bounded = true;
    for (uint32_t i = 0; i < cpu->lit; ++i) {
        const MappedCaster *caster = &cpu->casters[i];
        size_t points = hair_slots(cpu->lights[i].batch) * (size_t)mapped_caster_points(caster);
        float *reaching = map(cpu, &cpu->reaching[i].left, WRITTEN);
        if (!reaching) return error_set(error, RESULT_FAILED, "cannot write light on hair");
        shadow_past_find(&cpu->past, params, depths, caster, points, cpu->left[i], reaching,
                         cpu->map.parts);
    }
    return RESULT_OK;
}

Result hair_shadow_cpu_pass_mesh(HairShadowCpu *cpu, const ShadowParams *params,
                                 const GpuBuffer *texels, bool fresh, Error *error)
{
    cpu->bounded = cpu->bounded && !fresh;
    if (cpu->lit == 0) return RESULT_OK;
    const float *depths = map(cpu, texels, GL_MAP_READ_BIT);
    return depths ? pass_mesh(cpu, params, depths, error)
                  : error_set(error, RESULT_FAILED, "cannot read the mesh's shadows");
}
