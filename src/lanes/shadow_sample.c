// SPDX-License-Identifier: MIT
#include "lanes/shadow_sample.h"

#include "base/parallel.h"
#include "base/room.h"

#include "glsl/common/hash.h"

#include <stdlib.h>
#include <string.h>

enum { W = STRAND_TILE };

// The size of the groups of strands of which one strand is drawn.
static uint32_t find_step(MappedCasters casters, int least)
{
    uint64_t strands = 0;
    for (uint32_t i = 0; i < casters.count; ++i) strands += casters.list[i].material.drawn_strands;
    uint64_t step = least > 0 ? strands / (uint64_t)least : 1;
    return step > 1 ? (uint32_t)step : 1;
}

// The strand that represents a group of `step` strands: a pseudo-random but fixed choice.
static uint32_t choose(uint32_t group, uint32_t step)
{
    return hash_bits(group) % step;
}

typedef struct Take {
    const MappedCaster *from;
    float (*position)[4];
    uint32_t (*paint)[4]; // NULL without paint
    uint32_t step, tiles;
    int parts;
} Take;

static void take_tiles(void *data, int part)
{
    const Take *take = data;
    size_t vertices = take->from->material.vertex_count;
    uint32_t drawn = take->from->material.drawn_strands,
             end = (uint32_t)((uint64_t)take->tiles * ((uint64_t)part + 1) / (uint64_t)take->parts);
    for (uint32_t t = (uint32_t)((uint64_t)take->tiles * (uint64_t)part / (uint64_t)take->parts);
         t < end; ++t) {
        size_t from[W], to = t * vertices * W;
        for (uint32_t k = 0; k < W; ++k) {
            uint32_t group = t * W + k, strand = group * take->step + choose(group, take->step);
            if (strand >= drawn) strand = drawn - 1; // lanes and groups past the last strand
            from[k] = (strand / W) * vertices * W + strand % W;
        }
        for (size_t j = 0; j < vertices * W; j += W)
            for (size_t k = 0; k < W; ++k)
                memcpy(take->position[to + j + k], take->from->position[from[k] + j],
                       sizeof *take->position);
        for (size_t j = 0; take->paint && j < vertices * W; j += W)
            for (size_t k = 0; k < W; ++k)
                memcpy(take->paint[to + j + k], take->from->paint[from[k] + j],
                       sizeof *take->paint);
    }
}

static Result grow(void *array, size_t *room, size_t count, Error *error)
{
    return room_make(array, room, count, 4 * sizeof(float))
               ? RESULT_OK
               : error_set(error, RESULT_FAILED, "no memory for shadows of hair");
}

static size_t count_particles(const MappedCaster *caster, uint32_t step)
{
    size_t groups = ((size_t)caster->material.drawn_strands + step - 1) / step;
    return (groups + W - 1) / W * W * caster->material.vertex_count;
}

static Result make_room(ShadowSample *sample, MappedCasters casters, uint32_t step, Error *error)
{
    size_t positions = 0, painted = 0;
    if (sample->room < casters.count) {
        MappedCaster *room = realloc(sample->casters, casters.count * sizeof *room);
        if (!room)
            return error_set(error, RESULT_FAILED, "no memory for %u batches", casters.count);
        sample->casters = room;
        sample->room = casters.count;
    }
    if (step == 1) return RESULT_OK;
    for (uint32_t i = 0; i < casters.count; ++i) {
        size_t count = count_particles(&casters.list[i], step);
        positions += count;
        painted += casters.list[i].paint ? count : 0;
    }
    TRY(grow(&sample->position, &sample->position_room, positions, error));
    return grow(&sample->paint, &sample->paint_room, painted, error);
}

// Sets the weight of the drawn strands. The smaller share of the last strand is spread over all
// groups.
static void set_caster(MappedCaster *caster, const Take *take)
{
    MaterialParams *material = &caster->material;
    uint32_t groups = (material->drawn_strands + take->step - 1) / take->step;
    float strands = (float)(material->drawn_strands - 1) + material->last_share;
    caster->position = (const float(*)[4])take->position;
    caster->paint = (const uint32_t(*)[4])take->paint;
    caster->weight = strands / (float)groups;
    material->drawn_strands = groups;
    material->last_strand = groups - 1;
    material->last_share = 1;
}

Result shadow_sample_take(ShadowSample *sample, MappedCasters casters, int least, int parts,
                          MappedCasters *taken, Error *error)
{
    uint32_t step = find_step(casters, least);
    size_t position = 0, paint = 0;
    TRY(make_room(sample, casters, step, error));
    for (uint32_t i = 0; i < casters.count; ++i) {
        MappedCaster *caster = &sample->casters[i];
        *caster = casters.list[i];
        caster->points = NULL, caster->order = NULL;
        if (step == 1 || caster->material.drawn_strands == 0) continue;
        size_t count = count_particles(caster, step);
        Take take = {.from = &casters.list[i],
                     .position = sample->position + position,
                     .paint = caster->paint ? sample->paint + paint : NULL,
                     .step = step,
                     .tiles = (uint32_t)(count / W / caster->material.vertex_count),
                     .parts = parts};
        parallel_run(parts, take_tiles, &take);
        set_caster(caster, &take);
        position += count;
        paint += take.paint ? count : 0;
    }
    *taken = (MappedCasters){sample->casters, casters.count};
    return RESULT_OK;
}

void shadow_sample_destroy(ShadowSample *sample)
{
    free(sample->casters);
    free(sample->position);
    free(sample->paint);
    *sample = (ShadowSample){0};
}
