// SPDX-License-Identifier: MIT
// Positions for callers, strand by strand. On the GPU, strands are stored in tiles.
#include "library/library.h"

#include <stdlib.h>
#include <string.h>

static const Hair *hair_of(const TractrixSimulation *simulation, int section, TractrixPart part)
{
    const SimulationSection *of = &simulation->simulation.sections[section];
    return part == TRACTRIX_FOLLOWERS ? &of->follow.hair : &of->hair;
}

// The number of consecutive strands of a batch with the same strand number: the followers of a
// guide.
static uint32_t each_of(const TractrixSimulation *simulation, int section, TractrixPart part)
{
    return part == TRACTRIX_FOLLOWERS ? simulation->simulation.sections[section].follow.per_guide
                                      : 1;
}

static void unmap(LibraryMap *map)
{
    free(map->size);
    free(map->first);
    free(map->position);
    *map = (LibraryMap){0};
}

void library_end_copies(TractrixSimulation *simulation)
{
    for (uint32_t i = 0; simulation->maps && i < 2 * simulation->scene.section_count; ++i)
        gather_destroy(&simulation->maps[i].gather);
}

void library_unmap(TractrixSimulation *simulation)
{
    for (uint32_t i = 0; simulation->maps && i < 2 * simulation->scene.section_count; ++i)
        unmap(&simulation->maps[i]);
    free(simulation->maps);
}

// The index of a batch's strand in the order that callers know.
static uint32_t place_of(const HairBatch *batch, uint32_t s, uint32_t each)
{
    return batch->strand[s] * each + s % each;
}

static void order(LibraryMap *map, const Hair *hair, uint32_t each, uint32_t *begin)
{
    for (uint32_t i = 0; i < hair->batch_count; ++i)
        for (uint32_t s = 0; s < hair->batches[i].strand_count; ++s)
            map->size[place_of(&hair->batches[i], s, each)] = hair->batches[i].vertex_count;
    for (uint32_t s = 0, at = 0; s < map->strand_count; at += map->size[s++]) begin[s] = at;
    uint32_t *first = map->first;
    for (uint32_t i = 0; i < hair->batch_count; ++i)
        for (uint32_t s = 0; s < hair->batches[i].strand_count; ++s)
            *first++ = begin[place_of(&hair->batches[i], s, each)];
}

// Allocates the arrays at the first call.
static Result prepare(LibraryMap *map, const Hair *hair, uint32_t each, Error *error)
{
    size_t strands = hair->strand_count;
    if (map->size) return RESULT_OK;
    LibraryMap made = {.strand_count = hair->strand_count,
                       .vertex_count = (uint32_t)hair->particle_count,
                       .size = calloc(strands + 1, sizeof *made.size),
                       .first = calloc(strands + 1, sizeof *made.first)};
    uint32_t *begin = calloc(strands + 1, sizeof *begin);
    bool good = made.size && made.first && begin;
    if (good) order(&made, hair, each, begin);
    free(begin);
    if (good)
        *map = made;
    else
        unmap(&made);
    return good ? RESULT_OK : error_set(error, RESULT_FAILED, "no memory for %zu strands", strands);
}

static Result read_batch(LibraryMap *map, const HairBatch *batch, const uint32_t *first,
                         Error *error)
{
    float(*read)[4] = gpu_buffer_read(&batch->position);
    if (!read)
        return error_set(error, RESULT_FAILED, "no memory for the positions of %u strands",
                         batch->strand_count);
    for (uint32_t s = 0; s < batch->strand_count; ++s)
        for (uint32_t j = 0; j < batch->vertex_count; ++j) {
            float *to = map->position[first[s] + j];
            memcpy(to, read[hair_address(batch, s, j)], 3 * sizeof *to);
            to[3] = 1; // the GPU's holds what xyz have lost (glsl/sim/relative.glsl)
        }
    free(read);
    return RESULT_OK;
}

typedef struct Mapping {
    TractrixSimulation *simulation;
    int section;
    TractrixPart part;
    LibraryMap *map;
} Mapping;

static Result read_positions(void *data, Error *error)
{
    Mapping *mapping = data;
    LibraryMap *map = mapping->map;
    const Hair *hair = hair_of(mapping->simulation, mapping->section, mapping->part);
    TRY(prepare(map, hair, each_of(mapping->simulation, mapping->section, mapping->part), error));
    if (!map->position) map->position = malloc(map->vertex_count * sizeof *map->position + 1);
    if (!map->position)
        return error_set(error, RESULT_FAILED, "no memory for %u vertices", map->vertex_count);
    const uint32_t *first = map->first;
    for (uint32_t i = 0; i < hair->batch_count; first += hair->batches[i++].strand_count)
        TRY(read_batch(map, &hair->batches[i], first, error));
    return gpu_check("reading positions", error);
}

static Result begin(Mapping *mapping, TractrixSimulation *simulation, int section,
                    TractrixPart part, Error *error)
{
    int sections = (int)simulation->scene.section_count;
    if (section < 0 || section >= sections)
        return error_set(error, RESULT_USAGE, "section: got %d, expected 0 to %d", section,
                         sections - 1);
    if (part != TRACTRIX_GUIDES && part != TRACTRIX_FOLLOWERS)
        return error_set(error, RESULT_USAGE,
                         "part: got %d, expected TRACTRIX_GUIDES or TRACTRIX_FOLLOWERS", (int)part);
    LibraryMap *map = &simulation->maps[2 * section + (int)part];
    *mapping = (Mapping){simulation, section, part, map};
    return RESULT_OK;
}

TractrixResult tractrix_simulation_map(TractrixSimulation *simulation, int section,
                                       TractrixPart part, TractrixPositions *positions,
                                       TractrixError *error)
{
    LIBRARY_CALL;
    Error why = {{0}};
    Mapping mapping;
    TractrixPositions given;
    if (!simulation) return library_refuse(error, "simulation: got NULL");
    Result result = library_take(&given, sizeof given, positions, sizeof given, "positions", &why);
    THEN(result, begin(&mapping, simulation, section, part, &why));
    THEN(result, library_on_device(simulation->device, read_positions, &mapping, &why));
    if (result != RESULT_OK) return library_end(result, &why, error);
    given.strand_count = mapping.map->strand_count;
    given.vertex_count = mapping.map->vertex_count;
    given.sizes = mapping.map->size;
    given.position = mapping.map->position[0];
    library_give(positions, &given);
    return TRACTRIX_OK;
}

// --- Copying to a buffer of the host.

typedef struct Copying {
    Mapping mapping;
    GLuint buffer;
    int64_t offset;
} Copying;

static Result check_room(const Copying *copying, Error *error)
{
    GLint64 size = 0;
    int64_t wanted = 4 * (int64_t)sizeof(float) * (int64_t)copying->mapping.map->vertex_count;
    glBindBuffer(GL_COPY_WRITE_BUFFER, copying->buffer);
    glGetBufferParameteri64v(GL_COPY_WRITE_BUFFER, GL_BUFFER_SIZE, &size);
    glBindBuffer(GL_COPY_WRITE_BUFFER, 0);
    if (!copying->buffer || gpu_check("buffer", NULL) != RESULT_OK)
        return error_set(error, RESULT_USAGE,
                         "buffer: got %u, expected a buffer of the current context",
                         copying->buffer);
    if (copying->offset <= size && wanted <= size - copying->offset) return RESULT_OK;
    return error_set(error, RESULT_USAGE,
                     "buffer: has %lld bytes: expected at least %lld from byte %lld on",
                     (long long)size, (long long)wanted, (long long)copying->offset);
}

static Result copy_positions(void *data, Error *error)
{
    Copying *copying = data;
    Mapping *mapping = &copying->mapping;
    LibraryMap *map = mapping->map;
    const Hair *hair = hair_of(mapping->simulation, mapping->section, mapping->part);
    TRY(prepare(map, hair, each_of(mapping->simulation, mapping->section, mapping->part), error));
    TRY(check_room(copying, error));
    if (!map->vertex_count) return RESULT_OK;
    if (!map->gather.hair)
        TRY(gather_create(&map->gather, &mapping->simulation->device->gpu, hair, map->first,
                          error));
    gather_run(&map->gather, copying->buffer, copying->offset);
    return gpu_check("copying positions", error);
}

TractrixResult tractrix_simulation_copy_to_gl(TractrixSimulation *simulation, int section,
                                              TractrixPart part, uint32_t buffer, size_t offset,
                                              TractrixError *error)
{
    LIBRARY_CALL;
    Error why = {{0}};
    Copying copying = {.buffer = buffer, .offset = (int64_t)offset};
    if (!simulation) return library_refuse(error, "simulation: got NULL");
    if (!simulation->device->borrowed)
        return library_refuse(error, "buffer: the device is not borrowed, its context has no "
                                     "buffers of the caller's: expected tractrix_device_borrow");
    if (offset % 16 || offset > INT64_MAX)
        return library_refuse(error, "offset: got %zu, expected a multiple of 16", offset);
    Result result = begin(&copying.mapping, simulation, section, part, &why);
    THEN(result, library_on_device(simulation->device, copy_positions, &copying, &why));
    return library_end(result, &why, error);
}
