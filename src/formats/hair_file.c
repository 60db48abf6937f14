// SPDX-License-Identifier: MIT
// `.hair`, Cem Yuksel's HAIR files: a header of 128 bytes, then the arrays that are marked in a bit
// field of the header.
#include "formats/format.h"

#include <endian.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum {
    HAIR_HEADER_BYTES = 128,
    HAIR_INFO_BYTES = 88, // free text at the end of the header
    HAIR_HAS_SEGMENTS = 1,
    HAIR_HAS_POINTS = 2,
    HAIR_HAS_THICKNESS = 4,
    HAIR_HAS_TRANSPARENCY = 8,
    HAIR_HAS_COLOR = 16,
};

#define INFO_NAME "Tractrix"

// --- Reading.

typedef struct Header {
    uint32_t strands, points, arrays, default_segments;
    float default_transparency, default_color[3];
    char info[HAIR_INFO_BYTES + 1];
} Header;

static bool match(const Bytes *bytes)
{
    return bytes->size >= 4 && memcmp(bytes->data, "HAIR", 4) == 0;
}

// Fails with the byte `at` of the header as the place.
static void fail_at(Reader *reader, size_t at, const char *what)
{
    if (!reader_ok(reader)) return;
    reader->at = at;
    reader_fail(reader, "%s", what);
}

static Header read_header(Reader *reader)
{
    Header header = {0};
    reader->at = 4;
    header.strands = reader_read_u32(reader, "the number of strands");
    header.points = reader_read_u32(reader, "the number of points");
    header.arrays = reader_read_u32(reader, "the bits of the arrays");
    header.default_segments = reader_read_u32(reader, "the default number of segments");
    reader_read_f32(reader, "the default thickness");
    header.default_transparency = reader_read_f32(reader, "the default transparency");
    for (int i = 0; i < 3; i++)
        header.default_color[i] = reader_read_f32(reader, "the default colour");
    if (reader_ok(reader) && reader->size < HAIR_HEADER_BYTES)
        fail_at(reader, reader->size, "the file ends within the header of 128 bytes");
    if (reader_ok(reader))
        memcpy(header.info, reader->data + HAIR_HEADER_BYTES - HAIR_INFO_BYTES, HAIR_INFO_BYTES);
    reader->at = reader_ok(reader) ? HAIR_HEADER_BYTES : reader->at;
    if (header.strands == 0) fail_at(reader, 4, "0 strands: expected at least 1");
    if (header.points == 0) fail_at(reader, 8, "0 points: expected at least 2");
    if (!(header.arrays & HAIR_HAS_POINTS)) fail_at(reader, 12, "the file has no points");
    return header;
}

// Byte offsets of the arrays; `end` is behind the last one. All arrays are within the file.
typedef struct Layout {
    uint64_t segments, points, thickness, transparency, color, end;
} Layout;

static uint64_t lay_array(Reader *reader, const Header *header, uint32_t bit, uint64_t count,
                          uint32_t stride, uint64_t *end, const char *what)
{
    uint64_t start = *end;
    if (!(header->arrays & bit) || !reader_ok(reader)) return start;
    reader->at = start;
    if (reader_check_array(reader, start, count, stride, what)) *end = start + count * stride;
    return start;
}

static Layout lay_out(Reader *reader, const Header *header)
{
    Layout layout = {.end = HAIR_HEADER_BYTES};
    uint64_t points = header->points, *end = &layout.end;
    layout.segments =
        lay_array(reader, header, HAIR_HAS_SEGMENTS, header->strands, 2, end, "segment counts");
    layout.points = lay_array(reader, header, HAIR_HAS_POINTS, points, 12, end, "points");
    layout.thickness = lay_array(reader, header, HAIR_HAS_THICKNESS, points, 4, end, "thicknesses");
    layout.transparency =
        lay_array(reader, header, HAIR_HAS_TRANSPARENCY, points, 4, end, "transparencies");
    layout.color = lay_array(reader, header, HAIR_HAS_COLOR, points, 12, end, "colours");
    return layout;
}

// Without an array of segments, only the number of points bounds the number of strands.
static void check_default_segments(Reader *reader, const Header *header)
{
    if (!reader_ok(reader) || (header->arrays & HAIR_HAS_SEGMENTS)) return;
    uint64_t points = (uint64_t)header->strands * ((uint64_t)header->default_segments + 1);
    if (points == header->points) return;
    reader->at = 16;
    reader_fail(reader, "%u strands of %u segments each have %llu points, the header says %u",
                header->strands, header->default_segments, (unsigned long long)points,
                header->points);
}

static void read_sizes(FormatSource *source, Reader *reader, const Header *header,
                       const Layout *layout)
{
    uint64_t first = 0;
    reader->at = layout->segments;
    for (uint32_t s = 0; s < header->strands && reader_ok(reader); s++) {
        source->place[s] = layout->points + 12 * first;
        first += 1u + (header->arrays & HAIR_HAS_SEGMENTS
                           ? reader_read_u16(reader, "a number of segments")
                           : header->default_segments);
        if (first > header->points) {
            reader->at = 8;
            reader_fail(reader, "the segments of strand %u go beyond the %u points", s,
                        header->points);
        }
        source->strands.first[s + 1] = (uint32_t)first;
    }
    if (reader_ok(reader) && first != header->points) {
        reader->at = 8;
        reader_fail(reader, "the header says %u points, the segments add up to %llu",
                    header->points, (unsigned long long)first);
    }
}

static void read_colors(Strands *strands, Reader *reader, const Header *header,
                        const Layout *layout)
{
    bool has_color = header->arrays & HAIR_HAS_COLOR;
    bool has_transparency = header->arrays & HAIR_HAS_TRANSPARENCY;
    if (!reader_ok(reader) || !(has_color || has_transparency)) return;
    strands->color = reader_malloc(reader, strands->vertex_count, sizeof *strands->color);
    if (!strands->color) {
        reader_fail_memory(reader);
        return;
    }
    for (uint32_t v = 0; v < strands->vertex_count; v++) {
        float *color = strands->color[v], transparency = header->default_transparency;
        memcpy(color, header->default_color, 12);
        if (has_color) reader_copy_floats(reader, layout->color + 12 * (uint64_t)v, color, 3);
        if (has_transparency)
            reader_copy_floats(reader, layout->transparency + 4 * (uint64_t)v, &transparency, 1);
        color[3] = 1.0f - transparency;
    }
}

// The format has no field for unit and axis, so this program writes them into the header's text.
// Files of its older versions contain only its name; their up axis is y.
static void read_info(FormatSource *source, const char *info)
{
    float unit = 0;
    char up = 'y';
    if (strncmp(info, INFO_NAME, strlen(INFO_NAME)) != 0) return;
    int found = sscanf(info + strlen(INFO_NAME), ": unit %f m, %c up", &unit, &up);
    if (found == 2 && unit > 0 && isfinite(unit)) source->unit = unit;
    source->up = up == 'z' ? UP_Z : UP_Y;
}

// If the file has an array of either colour or transparency, the header's default replaces the
// other array. If it has neither, the defaults are ignored; so is the default thickness.
static Result read(FormatSource *source, Reader *reader)
{
    Header header = read_header(reader);
    Layout layout = lay_out(reader, &header);
    check_default_segments(reader, &header);
    if (!reader_ok(reader)) return reader->result;
    if (format_source_create(source, reader, header.strands, header.points) != RESULT_OK)
        return reader->result;
    source->vertex_stride = 12;
    read_info(source, header.info);
    source->unread_at = layout.end;
    source->unread_bytes = reader->size - layout.end;
    Strands *strands = &source->strands;
    read_sizes(source, reader, &header, &layout);
    if (!reader_ok(reader)) return reader->result;
    reader_copy_floats(reader, layout.points, strands->position[0], 3 * (size_t)header.points);
    if (header.arrays & HAIR_HAS_THICKNESS)
        format_source_copy(reader, &strands->vertex_thickness, layout.thickness, header.points, 1);
    strands->relative_widths = source->unit == 0; // those of other programs say no unit
    read_colors(strands, reader, &header, &layout);
    return reader->result;
}

// --- Writing.

static bool has_transparency(const Strands *strands)
{
    for (uint32_t v = 0; strands->color && v < strands->vertex_count; v++)
        if (strands->color[v][3] != 1.0f) return true;
    return false;
}

static void put_hair_header(FILE *stream, const Strands *strands, bool transparent, bool uneven)
{
    uint32_t arrays = HAIR_HAS_POINTS | (uneven ? HAIR_HAS_SEGMENTS : 0u) |
                      (strands->vertex_thickness ? HAIR_HAS_THICKNESS : 0u) |
                      (transparent ? HAIR_HAS_TRANSPARENCY : 0u) |
                      (strands->color ? HAIR_HAS_COLOR : 0u);
    // Defaults of thickness, transparency and colour.
    const float defaults[5] = {1.0f, 0.0f, 1.0f, 1.0f, 1.0f};
    char info[HAIR_INFO_BYTES] = "";
    snprintf(info, sizeof info, INFO_NAME ": unit %.9g m, %c up",
             strands->unit > 0 ? strands->unit : 1.0, strands->up_z ? 'z' : 'y');
    fwrite("HAIR", 1, 4, stream);
    format_put_u32(stream, strands->strand_count);
    format_put_u32(stream, strands->vertex_count);
    format_put_u32(stream, arrays);
    format_put_u32(stream, uneven ? 0 : strands_size(strands, 0) - 1);
    format_put_floats(stream, defaults, 5);
    fwrite(info, 1, sizeof info, stream);
}

static Result write(OutFile *file, const Strands *strands, Error *error)
{
    FILE *stream = file->stream;
    bool uneven = false, transparent = has_transparency(strands);
    for (uint32_t s = 0; s < strands->strand_count; s++) {
        uneven = uneven || strands_size(strands, s) != strands_size(strands, 0);
        if (strands_size(strands, s) - 1 > UINT16_MAX)
            return error_set(error, RESULT_FAILED,
                             "%s: strand %u has %u vertices: .hair files hold at most 65536",
                             file->path, s, strands_size(strands, s));
    }
    put_hair_header(stream, strands, transparent, uneven);
    for (uint32_t s = 0; uneven && s < strands->strand_count; s++) {
        uint16_t segments = htole16((uint16_t)(strands_size(strands, s) - 1));
        fwrite(&segments, 2, 1, stream);
    }
    format_put_floats(stream, strands->position[0], 3 * (size_t)strands->vertex_count);
    format_put_floats(stream, strands->vertex_thickness, strands->vertex_count);
    for (uint32_t v = 0; transparent && v < strands->vertex_count; v++) {
        float transparency = 1.0f - strands->color[v][3];
        format_put_floats(stream, &transparency, 1);
    }
    for (uint32_t v = 0; strands->color && v < strands->vertex_count; v++)
        format_put_floats(stream, strands->color[v], 3);
    return RESULT_OK;
}

const Format hair_format = {
    .name = "HAIR",
    .suffix = ".hair",
    .features = STRANDS_HAS_VERTEX_THICKNESS | STRANDS_HAS_COLOR, // opacity is kept within 2^-25
    .up_z = true, // as in straight.hair and other files of cemyuksel.com/research/hairmodels
    .match = match,
    .read = read,
    .write = write,
};
