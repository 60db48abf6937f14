// SPDX-License-Identifier: MIT
#include "export.h"
#include "strands_write.h"

#include <stdlib.h>
#include <string.h>
#include <strings.h>

// --- One set of strands from all sections.

// The arrays that a set may have or not.
static const struct {
    size_t offset, element;
    bool of_strands; // else of vertices
} OPTIONAL[] = {
    {offsetof(Strands, mobility), sizeof(float), false},
    {offsetof(Strands, strand_uv), sizeof(float[2]), true},
    {offsetof(Strands, vertex_uv), sizeof(float[2]), false},
    {offsetof(Strands, strand_thickness), sizeof(float), true},
    {offsetof(Strands, vertex_thickness), sizeof(float), false},
    {offsetof(Strands, color), sizeof(float[4]), false},
};

static char **array_at(const Strands *strands, size_t offset)
{
    return (char **)(void *)((char *)strands + offset);
}

static bool join_array(Strands *all, const Strands *sections, uint32_t count, size_t which)
{
    size_t offset = OPTIONAL[which].offset, element = OPTIONAL[which].element;
    bool of_strands = OPTIONAL[which].of_strands;
    for (uint32_t i = 0; i < count; ++i)
        if (!*array_at(&sections[i], offset)) return true;
    char *joined = malloc((of_strands ? all->strand_count : all->vertex_count) * element + 1);
    *array_at(all, offset) = joined;
    for (uint32_t i = 0; joined && i < count; ++i) {
        size_t size = (of_strands ? sections[i].strand_count : sections[i].vertex_count) * element;
        memcpy(joined, *array_at(&sections[i], offset), size);
        joined += size;
    }
    return *array_at(all, offset) != NULL;
}

static Result join(Strands *all, const Strands *sections, uint32_t count, Error *error)
{
    uint64_t strands = 0, vertices = 0;
    for (uint32_t i = 0; i < count; ++i) {
        strands += sections[i].strand_count;
        vertices += sections[i].vertex_count;
    }
    if (strands >= UINT32_MAX || vertices >= UINT32_MAX)
        return error_set(error, RESULT_FAILED, "more vertices than a hair file holds");
    Result result = strands_create(all, (uint32_t)strands, (uint32_t)vertices, error);
    if (result != RESULT_OK) return result;
    uint32_t s = 0, v = 0;
    for (uint32_t i = 0; i < count; ++i) {
        for (uint32_t k = 0; k < sections[i].strand_count; ++k)
            all->first[s++] = v + sections[i].first[k];
        v += sections[i].vertex_count;
    }
    all->first[s] = v;
    bool good = true;
    for (size_t i = 0; i < sizeof OPTIONAL / sizeof *OPTIONAL && good; ++i)
        good = join_array(all, sections, count, i);
    return good ? RESULT_OK : error_set(error, RESULT_FAILED, "no memory for a hair file");
}

static StrandsKind choose_kind(const Target *target, const Strands *strands)
{
    const char *name = target->after && *target->after ? target->after : target->before;
    size_t length = strlen(name);
    if (length >= 5 && strcasecmp(name + length - 5, ".hair") == 0) return STRANDS_HAIR;
    for (uint32_t s = 1; s < strands->strand_count; ++s)
        if (strands_size(strands, s) != strands_size(strands, 0)) return STRANDS_TFX2_TEXT;
    return STRANDS_TFX4;
}

Result exporter_create(Exporter *exporter, const char *text, int frame_count,
                       const Simulation *simulation, const Strands *strands, Error *error)
{
    *exporter = (Exporter){.simulation = simulation};
    Result result = target_parse_hair(&exporter->target, text, error);
    if (result == RESULT_OK && exporter->target.kind == TARGET_STILL && frame_count != 1)
        result = error_set(error, RESULT_USAGE,
                           "%s: one name for several frames, put the frame number into it: "
                           "frame_%%04d.tfx",
                           text);
    if (result == RESULT_OK) result = target_prepare(&exporter->target, error);
    if (result == RESULT_OK)
        result = join(&exporter->strands, strands, simulation->scene->section_count, error);
    if (result == RESULT_OK) exporter->kind = choose_kind(&exporter->target, &exporter->strands);
    if (result != RESULT_OK) exporter_destroy(exporter);
    return result;
}

void exporter_destroy(Exporter *exporter)
{
    target_destroy(&exporter->target);
    strands_destroy(&exporter->strands);
    *exporter = (Exporter){0};
}

// ---

// From the order of the batches to that of the file.
static void put_section(Strands *strands, uint32_t first_strand, const Hair *hair,
                        const float (*positions)[3])
{
    for (uint32_t i = 0; i < hair->batch_count; ++i) {
        const HairBatch *batch = &hair->batches[i];
        for (uint32_t s = 0; s < batch->strand_count; ++s) {
            uint32_t to = strands->first[first_strand + batch->strand[s]];
            memcpy(strands->position[to], positions, batch->vertex_count * sizeof *positions);
            positions += batch->vertex_count;
        }
    }
}

static Result read_positions(Exporter *exporter, Error *error)
{
    const Simulation *simulation = exporter->simulation;
    uint32_t first_strand = 0;
    Result result = RESULT_OK;
    for (uint32_t i = 0; i < simulation->scene->section_count && result == RESULT_OK; ++i) {
        const Hair *hair = &simulation->sections[i].hair;
        float(*positions)[3] = malloc(hair->particle_count * sizeof *positions + 1);
        if (!positions) return error_set(error, RESULT_FAILED, "no memory for a hair file");
        result = hair_read_positions(hair, positions, error);
        if (result == RESULT_OK)
            put_section(&exporter->strands, first_strand, hair, (const float(*)[3])positions);
        free(positions);
        first_strand += hair->strand_count;
    }
    return result;
}

Result exporter_write(Exporter *exporter, int frame, Error *error)
{
    Result result = read_positions(exporter, error);
    if (result != RESULT_OK) return result;
    char *name = target_name_frame(&exporter->target, frame);
    if (!name) return error_set(error, RESULT_FAILED, "no memory for the name of frame %d", frame);
    result = strands_write(name, exporter->kind, &exporter->strands, error);
    exporter->files += result == RESULT_OK;
    free(name);
    return result;
}
