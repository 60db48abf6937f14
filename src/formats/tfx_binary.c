// SPDX-License-Identifier: MIT
// TressFX 3 and 4 binary, following AMD's TressFXFileFormat.h: a header with offsets, then arrays
// of float32.
#include "formats/format.h"

#include <stdlib.h>
#include <string.h>

enum { TFX3_HEADER_BYTES = 296, TFX4_HEADER_BYTES = 160 };

// --- Reading.

static bool has_version(const Bytes *bytes, float least, float below)
{
    Reader reader = reader_begin_binary("", bytes, NULL);
    float version = reader_read_f32(&reader, "");
    return version >= least && version < below;
}

static bool match3(const Bytes *bytes)
{
    return has_version(bytes, 3, 4);
}

static bool match4(const Bytes *bytes)
{
    return has_version(bytes, 4, 5);
}

// An array that the header refers to.
typedef struct Array {
    uint32_t start;  // byte offset; 0 if absent
    size_t field_at; // byte offset of `start` in the header
} Array;

typedef struct Header {
    uint32_t strands, size; // size: vertices per strand
    size_t bytes;           // size of the header
    uint64_t end;           // end of the last array
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

// Checks that `count` records of `stride` bytes are within the file; true if the array is present
// and complete.
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

// Positions are the only required array. Checking them against the file's size bounds both counts.
// The caller reads the floats.
static Result begin_arrays(FormatSource *source, Reader *reader, Header *header, Array positions,
                           uint32_t stride)
{
    if (!reader_ok(reader)) return reader->result;
    reader->at = positions.field_at;
    if (positions.start == 0) return reader_fail(reader, "the file has no positions");
    uint64_t count = (uint64_t)header->strands * header->size;
    if (!check_array(reader, header, positions, count, stride, "positions")) return reader->result;
    if (format_source_create(source, reader, header->strands, count) != RESULT_OK)
        return reader->result;
    source->vertex_stride = stride;
    for (uint32_t s = 0; s < header->strands; s++) {
        source->place[s] = positions.start + (uint64_t)s * header->size * stride;
        source->strands.first[s + 1] = (s + 1) * header->size;
    }
    return RESULT_OK;
}

// Reads an optional array of `width` floats per record.
static void read_array(Reader *reader, Header *header, Array array, uint64_t count, size_t width,
                       const char *what, void *to)
{
    if (check_array(reader, header, array, count, 4 * width, what))
        format_source_copy(reader, to, array.start, count, width);
}

static void note_unread(FormatSource *source, const Reader *reader, const Header *header)
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

// Arrays without an offset in the header stay NULL.
static Result read3(FormatSource *source, Reader *reader)
{
    Header header = {.bytes = TFX3_HEADER_BYTES};
    float version = reader_read_f32(reader, "the version");
    read_counts(reader, &header);
    uint32_t followers = reader_read_u32(reader, "the number of followers");
    // A C++ bool: its three bytes of padding may have any value.
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
    // Guide indices: every strand is used as a guide, so the array is only checked to be complete.
    check_array(reader, &header, guides, header.strands, 4, "guide indices");
    read_array(reader, &header, vertex_uv, count, 2, "vertex UVs", &strands->vertex_uv);
    note_unread(source, reader, &header);
    return reader->result;
}

// Positions are float4: x, y, z, and in w whether the vertex may move.
static Result copy_positions4(Strands *strands, Reader *reader, uint64_t start)
{
    strands->mobility =
        reader_malloc(reader, ((size_t)strands->vertex_count + 1), sizeof *strands->mobility);
    if (!strands->mobility) return reader_fail_memory(reader);
    for (uint32_t v = 0; v < strands->vertex_count; v++) {
        float vertex[4];
        reader_copy_floats(reader, start + 16 * (uint64_t)v, vertex, 4);
        memcpy(strands->position[v], vertex, 12);
        strands->mobility[v] = vertex[3];
    }
    return RESULT_OK;
}

static Result read4(FormatSource *source, Reader *reader)
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

// --- Writing.

static void put_zeros(FILE *stream, size_t bytes)
{
    while (bytes--) fputc(0, stream);
}

// The number of vertices that all strands have, or 0 and an error.
static uint32_t find_common_size(const Strands *strands, const char *path, Error *error)
{
    uint32_t size = strands->strand_count ? strands_size(strands, 0) : 0;
    for (uint32_t s = 1; s < strands->strand_count; s++) {
        if (strands_size(strands, s) == size) continue;
        error_set(error, RESULT_FAILED,
                  "%s: strand %u has %u vertices, strand 0 has %u: expected equal numbers in a "
                  "binary TressFX file (--resample N makes them equal), or --format text or hair",
                  path, s, strands_size(strands, s), size);
        return 0;
    }
    return size;
}

// Advances `end` past an array of `count` times `floats` floats and returns where it starts; 0 if
// absent.
static uint32_t place_array(uint64_t *end, const void *array, uint64_t count, uint32_t floats)
{
    if (!array) return 0;
    uint64_t start = *end;
    *end += count * floats * 4;
    return (uint32_t)start;
}

static Result fail_too_large(const char *path, Error *error)
{
    return error_set(
        error, RESULT_FAILED,
        "%s: too much hair: expected less than 4 GiB, the limit of the offsets in binary TressFX",
        path);
}

static void put_counts(FILE *stream, float version, const Strands *strands, uint32_t size)
{
    format_put_floats(stream, &version, 1);
    format_put_u32(stream, strands->strand_count);
    format_put_u32(stream, size);
}

static Result write3(OutFile *file, const Strands *strands, Error *error)
{
    FILE *stream = file->stream;
    uint32_t size = find_common_size(strands, file->path, error);
    if (size == 0) return RESULT_FAILED;
    uint64_t count = strands->vertex_count, lines = strands->strand_count, end = TFX3_HEADER_BYTES;
    uint32_t position = place_array(&end, strands->position, count, 3);
    uint32_t thickness = place_array(&end, strands->strand_thickness, lines, 1);
    uint32_t strand_uv = place_array(&end, strands->strand_uv, lines, 2);
    uint32_t color = place_array(&end, strands->color, count, 4);
    uint32_t vertex_uv = place_array(&end, strands->vertex_uv, count, 2);
    if (end > UINT32_MAX) return fail_too_large(file->path, error);
    put_counts(stream, 3.0f, strands, size);
    format_put_u32(stream, strands->followers);
    format_put_u32(stream, strands->both_ends_fixed);
    put_zeros(stream, 31 * 4);
    format_put_u32(stream, position);
    format_put_u32(stream, thickness);
    format_put_u32(stream, strand_uv);
    format_put_u32(stream, color);
    format_put_u32(stream, 0); // no guide indices: all strands are guides
    format_put_u32(stream, vertex_uv);
    put_zeros(stream, 32 * 4);
    format_put_floats(stream, strands->position[0], 3 * count);
    format_put_floats(stream, strands->strand_thickness, lines);
    format_put_floats(stream, strands->strand_uv, 2 * lines);
    format_put_floats(stream, strands->color, 4 * count);
    format_put_floats(stream, strands->vertex_uv, 2 * count);
    return RESULT_OK;
}

static void put_positions4(FILE *stream, const Strands *strands)
{
    for (uint32_t s = 0; s < strands->strand_count; s++) {
        uint32_t root = strands->first[s], tip = strands->first[s + 1] - 1;
        for (uint32_t v = root; v <= tip; v++) {
            float mobility = v != root && !(strands->both_ends_fixed && v == tip) ? 1.0f : 0.0f;
            format_put_floats(stream, strands->position[v], 3);
            format_put_floats(stream, strands->mobility ? &strands->mobility[v] : &mobility, 1);
        }
    }
}

static Result write4(OutFile *file, const Strands *strands, Error *error)
{
    FILE *stream = file->stream;
    uint32_t size = find_common_size(strands, file->path, error);
    if (size == 0) return RESULT_FAILED;
    uint64_t count = strands->vertex_count, lines = strands->strand_count, end = TFX4_HEADER_BYTES;
    uint32_t position = place_array(&end, strands->position, count, 4);
    uint32_t strand_uv = place_array(&end, strands->strand_uv, lines, 2);
    uint32_t vertex_uv = place_array(&end, strands->vertex_uv, count, 2);
    uint32_t thickness = place_array(&end, strands->strand_thickness, lines, 1);
    uint32_t color = place_array(&end, strands->color, count, 4);
    if (end > UINT32_MAX) return fail_too_large(file->path, error);
    put_counts(stream, 4.0f, strands, size);
    format_put_u32(stream, position);
    format_put_u32(stream, strand_uv);
    format_put_u32(stream, vertex_uv);
    format_put_u32(stream, thickness);
    format_put_u32(stream, color);
    put_zeros(stream, 32 * 4);
    put_positions4(stream, strands);
    format_put_floats(stream, strands->strand_uv, 2 * lines);
    format_put_floats(stream, strands->vertex_uv, 2 * count);
    format_put_floats(stream, strands->strand_thickness, lines);
    format_put_floats(stream, strands->color, 4 * count);
    return RESULT_OK;
}

const Format tfx3_format = {
    .name = "TressFX 3 binary",
    .suffix = ".tfx",
    .features = STRANDS_HAS_STRAND_UV | STRANDS_HAS_VERTEX_UV | STRANDS_HAS_STRAND_THICKNESS |
                STRANDS_HAS_COLOR | STRANDS_HAS_FOLLOWERS | STRANDS_HAS_FIXED_ENDS,
    .equal_sizes = true,
    .no_millimetres = true,
    .match = match3,
    .read = read3,
    .write = write3,
};

// For strands without mobility, the format's w is 0 at the root (and at the tip if both ends are
// fixed) and 1 elsewhere, so fixed ends survive a round trip.
const Format tfx4_format = {
    .name = "TressFX 4 binary",
    .suffix = ".tfx",
    .features = STRANDS_HAS_MOBILITY | STRANDS_HAS_STRAND_UV | STRANDS_HAS_VERTEX_UV |
                STRANDS_HAS_STRAND_THICKNESS | STRANDS_HAS_COLOR | STRANDS_HAS_FIXED_ENDS,
    .equal_sizes = true,
    .no_millimetres = true,
    .match = match4,
    .read = read4,
    .write = write4,
};
