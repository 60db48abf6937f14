// SPDX-License-Identifier: MIT
// TressFX 2 text: `numStrands`, `is sorted`, then each strand's vertices. A block of parameters may
// come first.
#include "formats/format.h"

#include "base/decimal.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

// --- Reading.

// Sizes of the shortest legal forms, to bound counts: "strand 0 numVerts 0\n" and "0 0 0\n".
enum { BYTES_PER_STRAND = 20, BYTES_PER_VERTEX = 6 };

typedef struct Head {
    uint32_t strands;
    uint32_t max_vertices;
    uint32_t followers;
    float follower_radius;
    bool counted, sorted, sorting_given, ends_fixed;
    float version, scale, rotation[3], translation[3];
} Head;

static bool begins_with(const uint8_t *text, const char *word)
{
    size_t length = strlen(word);
    return strncmp((const char *)text, word, length) == 0 && strchr(" \t\r\n", text[length]);
}

static bool match(const Bytes *bytes)
{
    static const char *const words[] = {"numStrands",
                                        "is",
                                        "version",
                                        "scale",
                                        "rotation",
                                        "translation",
                                        "bothEndsImmovable",
                                        "maxNumVerticesInStrand",
                                        "numFollowHairsPerGuideHair",
                                        "maxRadiusAroundGuideHair"};
    const uint8_t *text = bytes->data + strspn((const char *)bytes->data, " \t\r\n");
    for (size_t i = 0; i < sizeof words / sizeof *words; i++)
        if (begins_with(text, words[i])) return true;
    return false;
}

static float read_finite(Reader *reader, const char *what)
{
    Reader before = *reader;
    float value = reader_read_number(reader, what);
    if (!reader_ok(reader) || isfinite(value)) return value;
    *reader = before;
    reader_fail_expected(reader, what);
    return 0.0f;
}

static void read_finite3(Reader *reader, float value[3], const char *what)
{
    for (int axis = 0; axis < 3; axis++) value[axis] = read_finite(reader, what);
}

static bool read_flag(Reader *reader, const char *what)
{
    if (reader_take(reader, "0")) return false;
    if (!reader_take(reader, "1") && reader_ok(reader)) reader_fail_expected(reader, what);
    return true;
}

static void read_strand_count(Reader *reader, Head *head)
{
    head->counted = true;
    head->strands = reader_read_count(reader, "the number of strands");
    uint64_t room = ((uint64_t)reader_left(reader) + 1) / BYTES_PER_STRAND;
    if (!reader_ok(reader)) return;
    if (head->strands == 0)
        reader_fail(reader, "numStrands 0: expected at least 1");
    else if (head->strands > room)
        reader_fail(reader,
                    "numStrands %u: expected at most %llu, the number that fits into the file",
                    head->strands, (unsigned long long)room);
}

// Reads one parameter; a line may have several.
static void read_parameter(Reader *reader, Head *head)
{
    if (reader_take(reader, "version")) {
        head->version = read_finite(reader, "the version");
    } else if (reader_take(reader, "scale")) {
        head->scale = read_finite(reader, "the scale");
        if (reader_ok(reader) && head->scale == 0.0f)
            reader_fail(reader, "scale 0: expected another number than 0");
    } else if (reader_take(reader, "rotation")) {
        read_finite3(reader, head->rotation, "an angle of rotation");
    } else if (reader_take(reader, "translation")) {
        read_finite3(reader, head->translation, "a coordinate of translation");
    } else if (reader_take(reader, "bothEndsImmovable")) {
        head->ends_fixed = read_flag(reader, "0 or 1 for bothEndsImmovable");
    } else if (reader_take(reader, "maxNumVerticesInStrand")) {
        head->max_vertices = reader_read_count(reader, "maxNumVerticesInStrand");
    } else if (reader_take(reader, "numFollowHairsPerGuideHair")) {
        head->followers = reader_read_count(reader, "numFollowHairsPerGuideHair");
    } else if (reader_take(reader, "maxRadiusAroundGuideHair")) {
        head->follower_radius = read_finite(reader, "maxRadiusAroundGuideHair");
    } else if (reader_take(reader, "numStrands")) {
        read_strand_count(reader, head);
    } else {
        reader_expect(reader, "is");
        reader_expect(reader, "sorted");
        head->sorted = read_flag(reader, "0 or 1 for is sorted");
        head->sorting_given = true;
    }
}

static Head read_head(Reader *reader)
{
    Head head = {.scale = 1.0f};
    while (reader_ok(reader) && !(head.counted && head.sorting_given)) {
        if (reader_ended(reader) || reader_line_ended(reader)) {
            reader_fail_expected(reader, head.counted ? "'is sorted'" : "'numStrands'");
            break;
        }
        // If a strand comes too early, name the missing word instead of listing all parameters.
        Reader before = *reader;
        if (reader_take(reader, "strand")) {
            *reader = before;
            reader_fail_expected(reader, head.counted ? "'is sorted'" : "'numStrands'");
        }
        read_parameter(reader, &head);
    }
    reader_next_line(reader);
    return head;
}

static void keep_head(FormatSource *source, const Head *head)
{
    source->version = head->version > 0.0f ? head->version : 2.0f;
    source->shuffle = !head->sorted;
    source->scale = head->scale;
    source->strands.followers = head->followers;
    source->strands.follower_radius = head->follower_radius;
    source->strands.both_ends_fixed = head->ends_fixed;
    const double turn = 6.283185307179586;
    for (int axis = 0; axis < 3; axis++) {
        source->translation[axis] = head->translation[axis];
        source->rotation[axis] = head->rotation[axis];
        if (fabs(source->rotation[axis]) > turn * 1.0001) source->rotation_was_deg = true;
    }
    for (int axis = 0; axis < 3 && source->rotation_was_deg; axis++)
        source->rotation[axis] *= turn / 360.0;
}

// "strand 3 numVerts 16 texcoord 0.5 0.25". The number is only a name, and the texture coordinate
// is optional.
static uint32_t read_strand_head(Reader *reader, FormatSource *source, uint32_t s)
{
    source->place[s] = reader->line;
    reader_expect(reader, "strand");
    reader_read_count(reader, "the strand's number");
    reader_expect(reader, "numVerts");
    uint32_t size = reader_read_count(reader, "the number of vertices");
    if (reader_take(reader, "texcoord")) {
        source->strands.strand_uv[s][0] = reader_read_number(reader, "u of texcoord");
        source->strands.strand_uv[s][1] = reader_read_number(reader, "v of texcoord");
    }
    uint64_t room = ((uint64_t)reader_left(reader) + 1) / BYTES_PER_VERTEX;
    if (reader_ok(reader) && size > room)
        reader_fail(reader,
                    "numVerts %u: expected at most %llu, the number that fits into the file", size,
                    (unsigned long long)room);
    reader_next_line(reader);
    return reader_ok(reader) ? size : 0;
}

static void read_strand(Reader *reader, FormatSource *source, uint32_t s, uint32_t max_vertices)
{
    Strands *strands = &source->strands;
    uint32_t v = strands->first[s];
    uint32_t size = read_strand_head(reader, source, s);
    if (max_vertices && size > max_vertices && source->over_limit++ == 0)
        source->over_limit_line = source->place[s];
    for (uint32_t end = v + size; v < end && reader_ok(reader); v++) {
        source->vertex_line[v] = reader->line;
        float *position = strands->position[v];
        position[0] = reader_read_number(reader, "a vertex's x");
        position[1] = reader_read_number(reader, "a vertex's y");
        position[2] = reader_read_number(reader, "a vertex's z");
        reader_next_line(reader);
    }
    strands->first[s + 1] = v;
}

static void read_strands(Reader *reader, FormatSource *source, const Head *head)
{
    for (uint32_t s = 0; s < head->strands && reader_ok(reader); s++) {
        if (reader_ended(reader) && reader_ok(reader))
            reader_fail(reader, "%u strands in the file: expected %u, the number in its header", s,
                        head->strands);
        read_strand(reader, source, s, head->max_vertices);
    }
    if (reader_ok(reader) && !reader_ended(reader))
        reader_fail_expected(reader, "the end of the file after the last strand");
}

// A rotation is in radians, as in AMD's loader, unless one of its numbers exceeds a full turn (2
// pi): then all three are in degrees.
static Result read(FormatSource *source, Reader *reader)
{
    Head head = read_head(reader);
    if (!reader_ok(reader)) return reader->result;
    // The number of vertices is not known yet, so make room for as many as the file could hold.
    uint64_t room = ((uint64_t)reader_left(reader) + 1) / BYTES_PER_VERTEX;
    if (format_source_create(source, reader, head.strands, room) != RESULT_OK)
        return reader->result;
    keep_head(source, &head);
    source->strands.strand_uv =
        reader_calloc(reader, head.strands, sizeof *source->strands.strand_uv);
    source->vertex_line = reader_malloc(reader, (room + 1), sizeof *source->vertex_line);
    if (!source->strands.strand_uv || !source->vertex_line) return reader_fail_memory(reader);
    read_strands(reader, source, &head);
    source->strands.vertex_count = source->strands.first[head.strands];
    return reader->result;
}

// --- Writing, with the shortest decimals that read back as the same number.

static void put_parameters(FILE *stream, const Strands *strands)
{
    uint32_t longest = 0;
    for (uint32_t s = 0; s < strands->strand_count; s++)
        if (strands_size(strands, s) > longest) longest = strands_size(strands, s);
    fprintf(stream, "version 2.0\nscale 1.0\nrotation 0 0 0\ntranslation 0 0 0\n");
    fprintf(stream, "bothEndsImmovable %d\nmaxNumVerticesInStrand %u\n", strands->both_ends_fixed,
            longest);
    fprintf(stream, "numFollowHairsPerGuideHair %u\n", strands->followers);
    decimal_put(stream, "maxRadiusAroundGuideHair ", strands->follower_radius);
    fputc('\n', stream);
}

static Result write(OutFile *file, const Strands *strands, Error *error)
{
    (void)error;
    FILE *stream = file->stream;
    if (strands->followers || strands->follower_radius != 0.0f || strands->both_ends_fixed)
        put_parameters(stream, strands);
    fprintf(stream, "numStrands %u\nis sorted 1\n", strands->strand_count);
    for (uint32_t s = 0; s < strands->strand_count; s++) {
        fprintf(stream, "strand %u numVerts %u texcoord", s, strands_size(strands, s));
        decimal_put(stream, " ", strands->strand_uv ? strands->strand_uv[s][0] : 0.0f);
        decimal_put(stream, " ", strands->strand_uv ? strands->strand_uv[s][1] : 0.0f);
        fputc('\n', stream);
        for (uint32_t v = strands->first[s]; v < strands->first[s + 1]; v++) {
            decimal_put(stream, "", strands->position[v][0]);
            decimal_put(stream, " ", strands->position[v][1]);
            decimal_put(stream, " ", strands->position[v][2]);
            fputc('\n', stream);
        }
    }
    return RESULT_OK;
}

const Format tfx2_format = {
    .name = "TressFX 2 text",
    .suffix = ".tfx",
    .features = STRANDS_HAS_STRAND_UV | STRANDS_HAS_FOLLOWERS | STRANDS_HAS_FOLLOWER_RADIUS |
                STRANDS_HAS_FIXED_ENDS,
    .text = true,
    .centimetres = true,
    .no_millimetres = true,
    .match = match,
    .read = read,
    .write = write,
};
