// SPDX-License-Identifier: MIT
// `.data` (USC-HairSalon) and `.bin` (CT2Hair): the number of strands, then each strand's number of
// vertices followed by the vertices, 3 or 7 floats each. The files have no signature, so a file is
// recognised by its strands ending exactly at the end of the file.
#include "formats/format.h"

enum { DATA_FLOATS = 3, BIN_FLOATS = 7 };

// Steps over all strands and returns the total number of vertices; 0 if the strands do not end
// exactly at the end of the file.
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

static bool match_data(const Bytes *bytes)
{
    return count_vertices(bytes, DATA_FLOATS) > 0;
}

static bool match_bin(const Bytes *bytes)
{
    return count_vertices(bytes, BIN_FLOATS) > 0;
}

// Reads the first 3 floats of each vertex and ignores the rest.
static Result read_floats(FormatSource *source, Reader *reader, int floats)
{
    Bytes bytes = {(uint8_t *)(uintptr_t)reader->data, reader->size};
    uint64_t vertices = count_vertices(&bytes, floats);
    uint32_t strands = reader_read_u32(reader, "the number of strands");
    if (format_source_create(source, reader, strands, vertices) != RESULT_OK) return reader->result;
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

static Result read_data(FormatSource *source, Reader *reader)
{
    return read_floats(source, reader, DATA_FLOATS);
}

static Result read_bin(FormatSource *source, Reader *reader)
{
    return read_floats(source, reader, BIN_FLOATS);
}

static Result write_data(OutFile *file, const Strands *strands, Error *error)
{
    (void)error;
    FILE *stream = file->stream;
    format_put_u32(stream, strands->strand_count);
    for (uint32_t s = 0; s < strands->strand_count; s++) {
        format_put_u32(stream, strands_size(strands, s));
        format_put_floats(stream, strands->position[strands->first[s]],
                          3 * (size_t)strands_size(strands, s));
    }
    return RESULT_OK;
}

const Format salon_data_format = {
    .name = "USC-HairSalon (.data)",
    .suffix = ".data",
    .match = match_data,
    .read = read_data,
    .write = write_data,
};

const Format salon_bin_format = {
    .name = "CT2Hair (.bin)",
    .suffix = ".bin",
    .match = match_bin,
    .read = read_bin,
};
