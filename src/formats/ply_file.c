// SPDX-License-Identifier: MIT
// `.ply` with strands, in one of three forms: hairutil's, in which an element `strand` has the
// number of each strand's segments (nsegs); points that edges join; and bare lists of points
// (cloud.h). Follows the files of hapPLY and hairutil. Integer colours are sRGB, float colours
// linear. Elements and properties with other names are skipped.
#include "formats/cloud.h"
#include "formats/foreign.h"
#include "formats/format.h"
#include "formats/ply.h"
#include "formats/ply_write.h"
#include "image/image.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

// The meaning of a property.
typedef enum PlyRole {
    PLY_X,
    PLY_Y,
    PLY_Z,
    PLY_RED,
    PLY_GREEN,
    PLY_BLUE,
    PLY_ALPHA,
    PLY_THICKNESS,
    PLY_SEGMENTS,
    PLY_VERTEX1,
    PLY_VERTEX2,
    PLY_ROLES
} PlyRole;

static const char *const ROLE_NAMES[PLY_ROLES] = {
    "x", "y", "z", "red", "green", "blue", "alpha", "thickness", "nsegs", "vertex1", "vertex2"};

typedef struct Ply {
    PlyFile file;
    Reader *reader;
    FormatSource *source;
    const PlyElement *vertices, *strands, *edges; // NULL if absent
    float (*position)[3];
    float (*color)[4];
    float *thickness;
    uint64_t *place; // [vertices] byte offset in the file
    uint32_t *line;  // [vertices]
    uint32_t *sizes; // [strands]
    uint8_t *joined; // [vertices] whether an edge leads to the next vertex
} Ply;

// --- Elements.

static void make_vertex_room(Ply *ply)
{
    size_t count = (size_t)ply->vertices->count + 1;
    const bool *has = ply->vertices->has;
    bool color = has[PLY_RED] && has[PLY_GREEN] && has[PLY_BLUE];
    ply->position = reader_malloc(ply->reader, count, sizeof *ply->position);
    ply->joined = reader_calloc(ply->reader, count, 1);
    if (ply->file.text)
        ply->line = reader_malloc(ply->reader, count, sizeof *ply->line);
    else
        ply->place = reader_malloc(ply->reader, count, sizeof *ply->place);
    if (color) ply->color = reader_malloc(ply->reader, count, sizeof *ply->color);
    if (has[PLY_THICKNESS])
        ply->thickness = reader_malloc(ply->reader, count, sizeof *ply->thickness);
    if (!ply->position || !ply->joined || !(ply->line || ply->place) || (color && !ply->color) ||
        (has[PLY_THICKNESS] && !ply->thickness))
        reader_fail_memory(ply->reader);
}

static void set_color(Ply *ply, uint32_t v, const double values[PLY_ROLES])
{
    double most = PLY_TYPE_INFO[ply_type_of(ply->vertices, PLY_RED)].most;
    double most_alpha = PLY_TYPE_INFO[ply_type_of(ply->vertices, PLY_ALPHA)].most;
    for (int k = 0; k < 3; k++) {
        double value = values[PLY_RED + k];
        ply->color[v][k] = (float)(most > 0 ? image_linear_from_srgb(value / most) : value);
    }
    double alpha = ply->vertices->has[PLY_ALPHA] ? values[PLY_ALPHA] : 1;
    if (ply->vertices->has[PLY_ALPHA] && most_alpha > 0) alpha /= most_alpha;
    ply->color[v][3] = (float)alpha;
}

static void read_vertices(Ply *ply, const PlyElement *element)
{
    Reader *reader = ply->reader;
    if (!element->has[PLY_X] || !element->has[PLY_Y] || !element->has[PLY_Z])
        reader_fail(reader, "vertices without x, y and z");
    if (element->count == 0) reader_fail(reader, "no vertices");
    if (!reader_ok(reader) || !ply_check_count(&ply->file, element)) return;
    ply->vertices = element;
    make_vertex_room(ply);
    for (uint32_t v = 0; v < element->count && reader_ok(reader); v++) {
        double values[PLY_ROLES] = {0};
        if (ply->file.text && reader_line_ended(reader)) reader_ended(reader);
        if (ply->file.text)
            ply->line[v] = reader->line;
        else
            ply->place[v] = reader->at;
        ply_read_row(&ply->file, element, values);
        for (int k = 0; k < 3; k++) ply->position[v][k] = (float)values[PLY_X + k];
        if (ply->color) set_color(ply, v, values);
        if (ply->thickness) ply->thickness[v] = (float)values[PLY_THICKNESS];
    }
}

static void read_strands(Ply *ply, const PlyElement *element)
{
    Reader *reader = ply->reader;
    if (!ply_check_count(&ply->file, element)) return;
    ply->strands = element;
    ply->sizes = reader_malloc(ply->reader, ((size_t)element->count + 1), sizeof *ply->sizes);
    for (uint32_t s = 0; s < element->count && reader_ok(reader); s++) {
        double values[PLY_ROLES] = {0};
        ply_read_row(&ply->file, element, values);
        if (!(values[PLY_SEGMENTS] >= 0 && values[PLY_SEGMENTS] < UINT32_MAX))
            reader_fail(reader, "strand %u has %g segments: expected a whole number from 0", s,
                        values[PLY_SEGMENTS]);
        ply->sizes[s] = reader_ok(reader) ? (uint32_t)values[PLY_SEGMENTS] + 1 : 0;
    }
}

static void read_edges(Ply *ply, const PlyElement *element)
{
    Reader *reader = ply->reader;
    if (!ply->vertices) reader_fail(reader, "edges before vertices: expected vertices first");
    if (!reader_ok(reader) || !ply_check_count(&ply->file, element)) return;
    ply->edges = element;
    for (uint32_t e = 0; e < element->count && reader_ok(reader); e++) {
        double values[PLY_ROLES] = {0}, last = ply->vertices->count - 1.0;
        ply_read_row(&ply->file, element, values);
        double a = fmin(values[PLY_VERTEX1], values[PLY_VERTEX2]);
        double b = fmax(values[PLY_VERTEX1], values[PLY_VERTEX2]);
        if (!(a >= 0 && b <= last && b == a + 1))
            reader_fail(reader,
                        "edge %u joins vertices %.0f and %.0f: expected two consecutive vertices "
                        "of the file's %u",
                        e, values[PLY_VERTEX1], values[PLY_VERTEX2], ply->vertices->count);
        if (reader_ok(reader)) ply->joined[(size_t)a] = 1;
    }
}

static void skip_element(Ply *ply, const PlyElement *element)
{
    double unused[PLY_ROLES];
    if (!ply_check_count(&ply->file, element) || element->property_count == 0) return;
    for (uint32_t i = 0; i < element->count && reader_ok(ply->reader); i++)
        ply_read_row(&ply->file, element, unused);
}

static void read_elements(Ply *ply)
{
    for (uint32_t i = 0; i < ply->file.element_count && reader_ok(ply->reader); i++) {
        const PlyElement *element = &ply->file.element[i];
        bool segments = element->has[PLY_SEGMENTS];
        bool ends = element->has[PLY_VERTEX1] && element->has[PLY_VERTEX2];
        if (strcmp(element->name, "vertex") == 0 && !ply->vertices)
            read_vertices(ply, element);
        else if (strcmp(element->name, "strand") == 0 && segments && !ply->strands)
            read_strands(ply, element);
        else if (strcmp(element->name, "edge") == 0 && ends && !ply->edges && element->count)
            read_edges(ply, element);
        else
            skip_element(ply, element);
    }
}

// Refuses meshes before it reads their data.
static void refuse_mesh(Ply *ply)
{
    for (uint32_t i = 0; i < ply->file.element_count && reader_ok(ply->reader); i++) {
        const PlyElement *element = &ply->file.element[i];
        if (element->count &&
            (strcmp(element->name, "face") == 0 || strcmp(element->name, "tristrips") == 0))
            reader_fail(ply->reader,
                        "a mesh of %u faces, not hair: " FOREIGN_WANTS_HAIR
                        "; tractrix-gen fur grows hair on a mesh",
                        element->count);
    }
}

// --- Strands.

// Counts the strands that edges make; a strand ends at a vertex that is not joined to the next one.
static uint32_t count_joined(Ply *ply)
{
    uint32_t strands = 0;
    for (uint32_t v = 0; v < ply->vertices->count; v++) strands += !ply->joined[v];
    return strands;
}

static uint32_t count_strands(Ply *ply, uint32_t *size)
{
    uint32_t count = ply->vertices->count;
    *size = 0;
    if (ply->strands) return ply->strands->count;
    if (ply->edges) return count_joined(ply);
    *size = cloud_find_size(ply->source, ply->reader, (const float(*)[3])ply->position, count);
    return *size ? count / *size : 0;
}

static void set_sizes(Ply *ply, uint32_t size)
{
    Strands *strands = &ply->source->strands;
    uint64_t end = 0;
    for (uint32_t s = 0; s < strands->strand_count && reader_ok(ply->reader); s++) {
        if (size) {
            end += size;
        } else if (ply->strands) {
            end += ply->sizes[s];
        } else {
            while (ply->joined[end]) end++;
            end++;
        }
        if (end > strands->vertex_count)
            reader_fail(ply->reader, "the strands need at least %llu vertices, but the file has %u",
                        (unsigned long long)end, strands->vertex_count);
        strands->first[s + 1] = (uint32_t)end;
    }
    if (reader_ok(ply->reader) && end != strands->vertex_count)
        reader_fail(ply->reader, "the strands need %llu vertices in all, but the file has %u",
                    (unsigned long long)end, strands->vertex_count);
}

static void make_strands(Ply *ply)
{
    Reader *reader = ply->reader;
    FormatSource *source = ply->source;
    uint32_t size;
    if (!ply->vertices) reader_fail(reader, "no vertices");
    if (!reader_ok(reader)) return;
    uint32_t strands = count_strands(ply, &size);
    if (!reader_ok(reader) || format_source_create(source, reader, strands, ply->vertices->count))
        return;
    set_sizes(ply, size);
    free(source->strands.position);
    source->strands.position = ply->position;
    source->strands.color = ply->color;
    source->strands.vertex_thickness = ply->thickness;
    source->vertex_line = ply->line;
    for (uint32_t s = 0; s < strands && reader_ok(reader); s++) {
        uint32_t v = source->strands.first[s];
        source->place[s] = ply->file.text ? ply->line[v] : ply->place[v];
    }
    if (!ply->file.text && ply->vertices->count > 1)
        source->vertex_stride = (uint32_t)(ply->place[1] - ply->place[0]);
    ply->position = NULL;
    ply->color = NULL;
    ply->thickness = NULL;
    ply->line = NULL;
}

static Result read(FormatSource *source, Reader *reader)
{
    Ply *ply = reader_calloc(reader, 1, sizeof *ply);
    if (!ply) return reader_fail_memory(reader);
    ply->reader = reader;
    ply->source = source;
    ply->file = (PlyFile){.reader = reader,
                          .roles = ROLE_NAMES,
                          .role_count = PLY_ROLES,
                          .first_whole = PLY_SEGMENTS,
                          .first_list = PLY_ROLES};
    ply_read_header(&ply->file);
    refuse_mesh(ply);
    read_elements(ply);
    make_strands(ply);
    if (reader_ok(reader) && !ply->file.text && reader_left(reader)) {
        source->unread_at = reader->at;
        source->unread_bytes = reader_left(reader);
    }
    free(ply->position);
    free(ply->color);
    free(ply->thickness);
    free(ply->place);
    free(ply->line);
    free(ply->sizes);
    free(ply->joined);
    free(ply);
    return reader->result;
}

// The first line is "ply"; the second one says whether the data is text or binary.
static bool match_kind(const Bytes *bytes, bool text)
{
    if (!ply_matches(bytes)) return false;
    const char *word = strstr((const char *)bytes->data, "format");
    bool ascii = word && strncmp(word + 6 + strspn(word + 6, " \t"), "ascii", 5) == 0;
    return ascii == text;
}

static bool match(const Bytes *bytes)
{
    return match_kind(bytes, false);
}

static bool match_text(const Bytes *bytes)
{
    return match_kind(bytes, true);
}

const Format ply_format = {
    .name = "PLY strands",
    .suffix = ".ply",
    .features = STRANDS_HAS_COLOR | STRANDS_HAS_VERTEX_THICKNESS,
    .match = match,
    .read = read,
    .write = ply_write,
};

const Format ply_text_format = {
    .name = "PLY strands as text",
    .suffix = ".ply",
    .features = STRANDS_HAS_COLOR | STRANDS_HAS_VERTEX_THICKNESS,
    .text = true,
    .match = match_text,
    .read = read,
    .write = ply_write_text,
};
