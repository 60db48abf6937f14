// SPDX-License-Identifier: MIT
#include "strands/formats/strands_source.h"

#include <stdlib.h>
#include <string.h>

Result strands_source_create(StrandsSource *source, Reader *reader, uint32_t strand_count,
                             uint64_t vertex_count)
{
    *source = (StrandsSource){0};
    if (vertex_count >= UINT32_MAX)
        return reader_fail(reader, "%llu vertices are more than 32-bit indices hold",
                           (unsigned long long)vertex_count);
    Result result = strands_create(&source->strands, strand_count, (uint32_t)vertex_count, NULL);
    source->place = calloc((size_t)strand_count + 1, sizeof *source->place);
    if (result == RESULT_OK && source->place) return RESULT_OK;
    strands_source_destroy(source);
    return reader_fail_memory(reader);
}

void strands_source_destroy(StrandsSource *source)
{
    strands_destroy(&source->strands);
    free(source->place);
    free(source->vertex_line);
    *source = (StrandsSource){0};
}

void strands_source_lay_out(StrandsSource *source, uint32_t size, uint64_t start, uint32_t stride)
{
    source->vertex_stride = stride;
    for (uint32_t s = 0; s < source->strands.strand_count; s++) {
        source->place[s] = start + (uint64_t)s * size * stride;
        source->strands.first[s + 1] = (s + 1) * size;
    }
}

Result strands_source_copy(Reader *reader, void *array, uint64_t start, size_t count, size_t width)
{
    float *floats = malloc((count * width + 1) * sizeof *floats);
    if (!floats) return reader_fail_memory(reader);
    reader_copy_floats(reader, start, floats, count * width);
    memcpy(array, &floats, sizeof floats);
    return RESULT_OK;
}
