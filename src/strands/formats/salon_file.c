// SPDX-License-Identifier: MIT
#include "strands/formats/salon_file.h"

// Steps over all strands; returns the vertices in all, or 0 where the file ends before them or
// goes on behind them.
static uint64_t count_vertices(const Bytes *bytes, int floats)
{
    Reader reader = reader_begin_binary("", bytes, NULL);
    uint32_t strands = reader_read_u32(&reader, "");
    uint64_t vertices = 0, stride = 4u * (uint64_t)floats;
    if (strands > reader_left(&reader) / 4) return 0;
    for (uint32_t s = 0; s < strands && reader_ok(&reader); s++) {
        uint32_t size = reader_read_u32(&reader, "");
        if (size > reader_left(&reader) / stride) return 0;
        reader.at += size * stride;
        vertices += size;
    }
    return reader_ok(&reader) && reader_left(&reader) == 0 ? vertices : 0;
}

int salon_file_match(const Bytes *bytes)
{
    if (count_vertices(bytes, SALON_DATA_FLOATS)) return SALON_DATA_FLOATS;
    return count_vertices(bytes, SALON_BIN_FLOATS) ? SALON_BIN_FLOATS : 0;
}

Result salon_file_read(StrandsSource *source, Reader *reader, int floats)
{
    Bytes bytes = {(uint8_t *)(uintptr_t)reader->data, reader->size};
    uint64_t vertices = count_vertices(&bytes, floats);
    uint32_t strands = reader_read_u32(reader, "the number of strands");
    if (strands_source_create(source, reader, strands, vertices) != RESULT_OK)
        return reader->result;
    source->vertex_stride = 4u * (uint32_t)floats;
    source->roots_only = true;
    uint32_t v = 0;
    for (uint32_t s = 0; s < strands && reader_ok(reader); s++) {
        uint32_t size = reader_read_u32(reader, "the number of vertices");
        source->place[s] = reader->at;
        for (uint32_t end = v + size; v < end; v++, reader->at += source->vertex_stride)
            reader_copy_floats(reader, reader->at, source->strands.position[v], 3);
        source->strands.first[s + 1] = v;
    }
    return reader->result;
}
