// SPDX-License-Identifier: MIT
#include "convert/cache_strands.h"

#include "base/reader.h"

#include <jansson.h>
#include <stdlib.h>
#include <string.h>

static Result fail(const CacheStrands *strands, const char *what, Error *error)
{
    return error_set(error, RESULT_BAD_INPUT, "%s: %s", strands->cache.file.path, what);
}

static Result read_fps(CacheStrands *strands, Error *error)
{
    const Bytes *text = &strands->cache.scene;
    json_t *scene = json_loadb((const char *)text->data, text->size, 0, NULL);
    strands->fps = json_number_value(json_object_get(scene, "fps"));
    json_decref(scene);
    return strands->fps > 0 ? RESULT_OK : fail(strands, "its scene has no fps", error);
}

// --- The hair: of each section runs of strands with so many vertices, then the strands' numbers in
// their file, in the order of the runs. A first pass counts, a second one places.

typedef struct Counts {
    uint64_t strands, vertices;
    bool good;
} Counts;

static void count_section(Reader *reader, Counts *counts)
{
    uint32_t strands = reader_read_u32(reader, "strands"), in_runs = 0;
    reader_read_u32(reader, "a checksum");
    uint32_t runs = reader_read_u32(reader, "runs");
    for (uint32_t i = 0; i < runs && reader_ok(reader); ++i) {
        uint32_t size = reader_read_u32(reader, "vertices"), count = reader_read_u32(reader, "");
        counts->vertices += (uint64_t)size * count;
        counts->good = counts->good && size >= 2 && count <= strands - in_runs;
        in_runs += count;
    }
    counts->strands += strands;
    counts->good = counts->good && in_runs == strands &&
                   reader_check_array(reader, reader->at, strands, 4, "numbers");
    if (counts->good) reader->at += 4 * (size_t)strands;
}

static Counts count_all(const Bytes *hair, uint32_t *sections)
{
    Reader reader = reader_begin_binary("", hair, NULL);
    Counts counts = {.good = true};
    *sections = reader_read_u32(&reader, "sections");
    for (uint32_t i = 0; i < *sections && counts.good && reader_ok(&reader); ++i)
        count_section(&reader, &counts);
    counts.good = counts.good && reader_ok(&reader) && reader_left(&reader) == 0 &&
                  counts.strands > 0 && counts.strands < UINT32_MAX && counts.vertices < UINT32_MAX;
    return counts;
}

// `sizes` takes each strand's vertices at its place + 1, 0 where there is none yet. The section's
// strands are first_strand and following.
static bool place_section(CacheStrands *to, Reader *reader, uint32_t section,
                          uint32_t *first_strand, uint32_t *sizes)
{
    uint32_t strands = reader_read_u32(reader, ""), place = *first_strand;
    reader_read_u32(reader, "");
    uint32_t runs = reader_read_u32(reader, "");
    size_t numbers_at = reader->at + 8 * (size_t)runs;
    for (uint32_t i = 0; i < runs; ++i) {
        uint32_t size = reader_read_u32(reader, ""), count = reader_read_u32(reader, "");
        Reader numbers = *reader;
        numbers.at = numbers_at + 4 * (size_t)(place - *first_strand);
        for (uint32_t k = 0; k < count; ++k, ++place) {
            uint32_t number = reader_read_u32(&numbers, "");
            if (number >= strands || sizes[*first_strand + number + 1]) return false;
            to->order[place] = *first_strand + number;
            to->section[place] = section;
            sizes[*first_strand + number + 1] = size;
        }
    }
    reader->at = numbers_at + 4 * (size_t)strands;
    *first_strand += strands;
    return true;
}

static Result place_all(CacheStrands *strands, Error *error)
{
    Reader reader = reader_begin_binary("", &strands->cache.hair, NULL);
    uint32_t *first = strands->layout.first, strand = 0;
    reader_read_u32(&reader, "");
    for (uint32_t i = 0; i < strands->section_count; ++i)
        if (!place_section(strands, &reader, i, &strand, first))
            return fail(strands, "its hair has a strand twice", error);
    for (uint32_t s = 0; s < strands->layout.strand_count; ++s) first[s + 1] += first[s];
    return RESULT_OK;
}

static Result read_hair(CacheStrands *strands, Error *error)
{
    Counts counts = count_all(&strands->cache.hair, &strands->section_count);
    if (!counts.good) return fail(strands, "its hair is not what docs/cache.md says", error);
    Result result = strands_create(&strands->layout, (uint32_t)counts.strands,
                                   (uint32_t)counts.vertices, error);
    if (result != RESULT_OK) return result;
    strands->order = malloc(counts.strands * sizeof *strands->order);
    strands->section = malloc(counts.strands * sizeof *strands->section);
    strands->positions = malloc(counts.vertices * sizeof *strands->positions);
    if (strands->order && strands->section && strands->positions) return place_all(strands, error);
    return error_set(error, RESULT_FAILED, "%s: no memory for a frame", strands->cache.file.path);
}

Result cache_strands_open(CacheStrands *strands, const char *path, Error *error)
{
    *strands = (CacheStrands){0};
    Result result = cache_file_open(&strands->cache, path, error);
    if (result == RESULT_OK) result = read_fps(strands, error);
    if (result == RESULT_OK) result = read_hair(strands, error);
    if (result != RESULT_OK) cache_strands_close(strands);
    return result;
}

void cache_strands_close(CacheStrands *strands)
{
    cache_file_close(&strands->cache);
    strands_destroy(&strands->layout);
    free(strands->order);
    free(strands->section);
    free(strands->positions);
    *strands = (CacheStrands){0};
}

Result cache_strands_read(CacheStrands *strands, int frame, Strands *read, Error *error)
{
    const Strands *layout = &strands->layout;
    float head[CACHE_HEAD_FLOATS], (*at)[3] = strands->positions;
    *read = (Strands){0};
    Result result = cache_file_read(&strands->cache, frame, head, at, layout->vertex_count, error);
    if (result == RESULT_OK)
        result = strands_create(read, layout->strand_count, layout->vertex_count, error);
    if (result != RESULT_OK) return result;
    memcpy(read->first, layout->first, ((size_t)layout->strand_count + 1) * sizeof *read->first);
    for (uint32_t i = 0; i < layout->strand_count; ++i) {
        uint32_t s = strands->order[i], size = strands_size(layout, s);
        memcpy(read->position[layout->first[s]], at, size * sizeof *at);
        at += size;
    }
    return RESULT_OK;
}
