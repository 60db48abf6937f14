// SPDX-License-Identifier: MIT
#include "strands/formats/tfx_binary.h"

#include <stdlib.h>
#include <string.h>

float tfx_binary_version(const Bytes *bytes)
{
    Reader reader = reader_begin_binary("", bytes, NULL);
    float version = reader_read_f32(&reader, "");
    return version >= 3.0f && version < 5.0f ? version : 0.0f;
}

// An array that the header speaks of.
typedef struct Array {
    uint32_t start;  // byte; 0: absent
    size_t field_at; // where the header says so
} Array;

typedef struct Header {
    uint32_t strands, size; // size: vertices per strand
    size_t bytes;           // of the header itself
    uint64_t end;           // of the last array
} Header;

static void read_counts(Reader *reader, Header *header)
{
    header->strands = reader_read_u32(reader, "the number of strands");
    if (reader_ok(reader) && header->strands == 0) {
        reader->at -= 4;
        reader_fail(reader, "0 strands: expected at least 1");
    }
    header->size = reader_read_u32(reader, "the number of vertices per strand");
    if (reader_ok(reader) && header->size == 0) {
        reader->at -= 4;
        reader_fail(reader, "0 vertices per strand: expected at least 2");
    }
}

static Array read_offset(Reader *reader)
{
    Array array = {.field_at = reader->at};
    array.start = reader_read_u32(reader, "an offset");
    return array;
}

// Checks that `count` records of `stride` bytes are there; true if the array is present and whole.
static bool check_array(Reader *reader, Header *header, Array array, uint64_t count,
                        uint64_t stride, const char *what)
{
    if (!reader_ok(reader) || array.start == 0) return false;
    reader->at = array.field_at;
    if (array.start < header->bytes) {
        reader_fail(reader, "%s start at byte %u, within the header of %zu bytes", what,
                    array.start, header->bytes);
        return false;
    }
    if (!reader_check_array(reader, array.start, count, stride, what)) return false;
    uint64_t end = array.start + count * stride;
    if (end > header->end) header->end = end;
    return true;
}

// Positions are the one array that must be there, and checking them bounds both counts by the
// file's size. Their floats are left to the caller.
static Result begin_arrays(StrandsSource *source, Reader *reader, Header *header, Array positions,
                           uint32_t stride)
{
    if (!reader_ok(reader)) return reader->result;
    reader->at = positions.field_at;
    if (positions.start == 0) return reader_fail(reader, "the file has no positions");
    uint64_t count = (uint64_t)header->strands * header->size;
    if (!check_array(reader, header, positions, count, stride, "positions")) return reader->result;
    if (strands_source_create(source, reader, header->strands, count) != RESULT_OK)
        return reader->result;
    strands_source_lay_out(source, header->size, positions.start, stride);
    return RESULT_OK;
}

// An optional array of `width` floats a record.
static void read_array(Reader *reader, Header *header, Array array, uint64_t count, size_t width,
                       const char *what, void *to)
{
    if (check_array(reader, header, array, count, 4 * width, what))
        strands_source_copy(reader, to, array.start, count, width);
}

static void note_unread(StrandsSource *source, const Reader *reader, const Header *header)
{
    source->unread_at = header->end;
    source->unread_bytes = reader->size - header->end;
}

static Result skip_to_offsets(Reader *reader, const Header *header, size_t offsets_at)
{
    if (reader_ok(reader) && reader->size < header->bytes) {
        reader->at = reader->size;
        return reader_fail(reader, "the file ends within the header of %zu bytes", header->bytes);
    }
    reader->at = offsets_at;
    return reader->result;
}

Result tfx3_read(StrandsSource *source, Reader *reader)
{
    Header header = {.bytes = TFX3_HEADER_BYTES};
    float version = reader_read_f32(reader, "the version");
    read_counts(reader, &header);
    uint32_t followers = reader_read_u32(reader, "the number of followers");
    // A C++ bool with three bytes of padding that nobody promised to be zero.
    bool ends_fixed = (reader_read_u32(reader, "bothEndsImmovable") & 0xff) != 0;
    if (skip_to_offsets(reader, &header, 144) != RESULT_OK) return reader->result;
    Array positions = read_offset(reader), thickness = read_offset(reader);
    Array strand_uv = read_offset(reader), color = read_offset(reader);
    Array guides = read_offset(reader), vertex_uv = read_offset(reader);
    if (begin_arrays(source, reader, &header, positions, 12) != RESULT_OK) return reader->result;
    Strands *strands = &source->strands;
    source->version = version;
    strands->followers = followers;
    strands->both_ends_fixed = ends_fixed;
    uint64_t count = strands->vertex_count;
    reader_copy_floats(reader, positions.start, strands->position[0], 3 * count);
    read_array(reader, &header, thickness, header.strands, 1, "thicknesses",
               &strands->strand_thickness);
    read_array(reader, &header, strand_uv, header.strands, 2, "strand UVs", &strands->strand_uv);
    read_array(reader, &header, color, count, 4, "colours", &strands->color);
    // Which strands are guides: all of these are, so the indices only have to be whole.
    check_array(reader, &header, guides, header.strands, 4, "guide indices");
    read_array(reader, &header, vertex_uv, count, 2, "vertex UVs", &strands->vertex_uv);
    note_unread(source, reader, &header);
    return reader->result;
}

// float4 positions: x, y, z, and in w whether the vertex may move.
static Result copy_positions4(Strands *strands, Reader *reader, uint64_t start)
{
    strands->mobility = malloc(((size_t)strands->vertex_count + 1) * sizeof *strands->mobility);
    if (!strands->mobility) return reader_fail_memory(reader);
    for (uint32_t v = 0; v < strands->vertex_count; v++) {
        float vertex[4];
        reader_copy_floats(reader, start + 16 * (uint64_t)v, vertex, 4);
        memcpy(strands->position[v], vertex, 12);
        strands->mobility[v] = vertex[3];
    }
    return RESULT_OK;
}

Result tfx4_read(StrandsSource *source, Reader *reader)
{
    Header header = {.bytes = TFX4_HEADER_BYTES};
    float version = reader_read_f32(reader, "the version");
    read_counts(reader, &header);
    if (skip_to_offsets(reader, &header, 12) != RESULT_OK) return reader->result;
    Array positions = read_offset(reader), strand_uv = read_offset(reader);
    Array vertex_uv = read_offset(reader), thickness = read_offset(reader);
    Array color = read_offset(reader);
    if (begin_arrays(source, reader, &header, positions, 16) != RESULT_OK) return reader->result;
    Strands *strands = &source->strands;
    source->version = version;
    uint64_t count = strands->vertex_count;
    if (copy_positions4(strands, reader, positions.start) != RESULT_OK) return reader->result;
    read_array(reader, &header, strand_uv, header.strands, 2, "strand UVs", &strands->strand_uv);
    read_array(reader, &header, vertex_uv, count, 2, "vertex UVs", &strands->vertex_uv);
    read_array(reader, &header, thickness, header.strands, 1, "thicknesses",
               &strands->strand_thickness);
    read_array(reader, &header, color, count, 4, "colours", &strands->color);
    note_unread(source, reader, &header);
    return reader->result;
}
