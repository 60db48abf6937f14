// SPDX-License-Identifier: MIT
// `.ply` with strands: hairutil's form, in which an element `strand` has the number of each
// strand's segments (nsegs); points that edges join; and bare lists of points (cloud.h). After
// Greg Turk's "The PLY Polygon File Format" (1994) and the files of hapPLY and hairutil. Colours of
// integers are sRGB, of floats linear. Elements and properties of other names are stepped over.
#include "image/image.h"
#include "strands/formats/cloud.h"
#include "strands/formats/format.h"
#include "strands/formats/ply_write.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { MOST_ELEMENTS = 32, MOST_PROPERTIES = 256, NAME_SIZE = 40 };

typedef enum PlyType {
    PLY_CHAR,
    PLY_UCHAR,
    PLY_SHORT,
    PLY_USHORT,
    PLY_INT,
    PLY_UINT,
    PLY_FLOAT,
    PLY_DOUBLE,
    PLY_TYPES
} PlyType;

static const struct {
    const char *name, *alias;
    uint32_t size;
    double most; // of an unsigned colour; 0: colours are linear
} TYPES[PLY_TYPES] = {{"char", "int8", 1, 0},     {"uchar", "uint8", 1, 255},
                      {"short", "int16", 2, 0},   {"ushort", "uint16", 2, 65535},
                      {"int", "int32", 4, 0},     {"uint", "uint32", 4, 0},
                      {"float", "float32", 4, 0}, {"double", "float64", 8, 0}};

// What a property is for.
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

typedef struct PlyProperty {
    PlyType type, count_type; // of a list's elements and of their number
    bool list;
    PlyRole role; // PLY_ROLES: stepped over
} PlyProperty;

typedef struct PlyElement {
    char name[NAME_SIZE];
    uint32_t count, property_count;
    PlyProperty *property; // of the file's
    bool has[PLY_ROLES];
} PlyElement;

typedef struct Ply {
    Reader *reader;
    FormatSource *source;
    bool text, big; // big: most significant byte first
    PlyElement element[MOST_ELEMENTS];
    PlyProperty property[MOST_PROPERTIES];
    uint32_t element_count, property_count;
    const PlyElement *vertices, *strands, *edges; // NULL: none
    float (*position)[3];
    float (*color)[4];
    float *thickness;
    uint64_t *place; // [vertices] byte
    uint32_t *line;  // [vertices]
    uint32_t *sizes; // [strands]
    uint8_t *joined; // [vertices] to the next one
} Ply;

// --- The header: lines of words.

static void read_name(Ply *ply, char name[NAME_SIZE], const char *what)
{
    if (reader_ok(ply->reader) && !reader_read_word(ply->reader, name, NAME_SIZE)) {
        name[0] = 0;
        reader_fail_expected(ply->reader, what);
    }
}

static PlyType read_type(Ply *ply)
{
    for (int type = 0; type < PLY_TYPES; type++)
        if (reader_take(ply->reader, TYPES[type].name) ||
            reader_take(ply->reader, TYPES[type].alias))
            return (PlyType)type;
    if (reader_ok(ply->reader)) reader_fail_expected(ply->reader, "a type (float, uchar, ...)");
    return PLY_CHAR;
}

static void read_format(Ply *ply)
{
    Reader *reader = ply->reader;
    if (reader_take(reader, "ascii"))
        ply->text = true;
    else if (reader_take(reader, "binary_big_endian"))
        ply->big = true;
    else if (!reader_take(reader, "binary_little_endian") && reader_ok(reader))
        reader_fail_expected(reader, "ascii, binary_little_endian or binary_big_endian");
    reader_expect(reader, "1.0");
}

static void read_element(Ply *ply)
{
    if (ply->element_count == MOST_ELEMENTS) {
        reader_fail(ply->reader, "more than %d elements", MOST_ELEMENTS);
        return;
    }
    PlyElement *element = &ply->element[ply->element_count++];
    element->property = ply->property + ply->property_count;
    read_name(ply, element->name, "an element's name");
    element->count = reader_read_count(ply->reader, "a number of elements");
}

static void read_property(Ply *ply)
{
    Reader *reader = ply->reader;
    char name[NAME_SIZE] = "";
    if (ply->element_count == 0) reader_fail(reader, "a property before any element");
    if (ply->property_count == MOST_PROPERTIES)
        reader_fail(reader, "more than %d properties", MOST_PROPERTIES);
    if (!reader_ok(reader)) return;
    PlyElement *element = &ply->element[ply->element_count - 1];
    PlyProperty *property = &ply->property[ply->property_count++];
    property->list = reader_take(reader, "list");
    if (property->list) property->count_type = read_type(ply);
    if (property->list && property->count_type >= PLY_FLOAT)
        reader_fail(reader, "a list's count is a float: expected an integer");
    property->type = read_type(ply);
    read_name(ply, name, "a property's name");
    property->role = PLY_ROLES;
    for (int role = 0; role < PLY_ROLES && !property->list; role++)
        if (strcmp(name, ROLE_NAMES[role]) == 0 && !element->has[role])
            property->role = (PlyRole)role;
    if (property->role < PLY_ROLES) element->has[property->role] = true;
    element->property_count++;
}

// Up to the newline behind end_header, which a carriage return may precede; data may begin with any
// byte.
static void end_header(Ply *ply)
{
    Reader *reader = ply->reader;
    const uint8_t *at = reader->data + reader->at;
    size_t step = at[0] == '\n' ? 1 : at[0] == '\r' && at[1] == '\n' ? 2 : 0;
    if (step == 0 && reader_ok(reader)) reader_fail_expected(reader, "the end of the line");
    reader->at += step;
    reader->line++;
}

static void read_header(Ply *ply)
{
    Reader *reader = ply->reader;
    reader->line = 1;
    reader_expect(reader, "ply");
    reader_next_line(reader);
    reader_expect(reader, "format");
    if (reader_ok(reader)) read_format(ply);
    reader_next_line(reader);
    while (reader_ok(reader) && !reader_take(reader, "end_header")) {
        if (reader_take(reader, "comment") || reader_take(reader, "obj_info")) {
            reader_skip_line(reader);
            continue;
        }
        if (reader_take(reader, "element"))
            read_element(ply);
        else if (reader_take(reader, "property"))
            read_property(ply);
        else
            reader_fail_expected(reader, "element, property, comment or end_header");
        reader_next_line(reader);
    }
    if (reader_ok(reader)) end_header(ply);
    if (!ply->text) reader->line = 0;
}

// --- Numbers.

// Of any type; the bytes are there.
static double convert_bytes(const Ply *ply, const uint8_t *bytes, PlyType type)
{
    uint64_t bits = 0;
    uint32_t size = TYPES[type].size;
    for (uint32_t i = 0; i < size; i++)
        bits |= (uint64_t)bytes[ply->big ? size - 1 - i : i] << (8 * i);
    uint32_t low = (uint32_t)bits;
    float single;
    double wide;
    memcpy(&single, &low, sizeof single);
    memcpy(&wide, &bits, sizeof wide);
    switch (type) {
    case PLY_CHAR:
        return (int8_t)low;
    case PLY_SHORT:
        return (int16_t)low;
    case PLY_INT:
        return (int32_t)low;
    case PLY_FLOAT:
        return (double)single;
    case PLY_DOUBLE:
        return wide;
    default:
        return low;
    }
}

static double read_number(Ply *ply, PlyType type, bool whole)
{
    Reader *reader = ply->reader;
    if (!reader_ok(reader)) return 0;
    if (!ply->text) {
        uint32_t size = TYPES[type].size;
        if (!reader_check_array(reader, reader->at, 1, size, "the element's numbers")) return 0;
        double value = convert_bytes(ply, reader->data + reader->at, type);
        reader->at += size;
        return value;
    }
    if (reader_line_ended(reader)) reader_ended(reader);
    if (whole) return reader_read_count(reader, "a whole number from 0");
    return (double)reader_read_number(reader, "a number");
}

static void skip_list(Ply *ply, const PlyProperty *property)
{
    Reader *reader = ply->reader;
    double count = read_number(ply, property->count_type, true);
    if (count < 0) reader_fail(reader, "a list of %g numbers", count);
    if (!reader_ok(reader)) return;
    if (ply->text) {
        for (uint64_t i = 0; i < (uint64_t)count && reader_ok(reader); i++)
            read_number(ply, property->type, false);
    } else if (reader_check_array(reader, reader->at, (uint64_t)count, TYPES[property->type].size,
                                  "a list")) {
        reader->at += (size_t)count * TYPES[property->type].size;
    }
}

// One element of its kind; the numbers that have a role go to `values`.
static void read_row(Ply *ply, const PlyElement *element, double values[PLY_ROLES])
{
    for (uint32_t i = 0; i < element->property_count && reader_ok(ply->reader); i++) {
        const PlyProperty *property = &element->property[i];
        if (property->list) {
            skip_list(ply, property);
            continue;
        }
        bool whole = property->role >= PLY_SEGMENTS && property->role < PLY_ROLES;
        double value = read_number(ply, property->type, whole);
        if (property->role < PLY_ROLES) values[property->role] = value;
    }
}

// The least that an element takes in the file, bytes: in text a digit and a blank for each number.
static uint64_t least_size(const Ply *ply, const PlyElement *element)
{
    uint64_t size = 0;
    for (uint32_t i = 0; i < element->property_count; i++) {
        const PlyProperty *property = &element->property[i];
        size += ply->text ? 2 : TYPES[property->list ? property->count_type : property->type].size;
    }
    return size;
}

static bool check_count(Ply *ply, const PlyElement *element)
{
    uint64_t size = least_size(ply, element), left = reader_left(ply->reader) + ply->text;
    if (size == 0 || element->count <= left / size) return true;
    reader_fail(ply->reader, "%u times '%s' need %llu bytes at least, the file has %zu more",
                element->count, element->name, (unsigned long long)size * element->count,
                reader_left(ply->reader));
    return false;
}

// --- Elements.

static PlyType type_of(const PlyElement *element, PlyRole role)
{
    for (uint32_t i = 0; i < element->property_count; i++)
        if (!element->property[i].list && element->property[i].role == role)
            return element->property[i].type;
    return PLY_FLOAT;
}

static void make_vertex_room(Ply *ply)
{
    size_t count = (size_t)ply->vertices->count + 1;
    const bool *has = ply->vertices->has;
    bool color = has[PLY_RED] && has[PLY_GREEN] && has[PLY_BLUE];
    ply->position = malloc(count * sizeof *ply->position);
    ply->joined = calloc(count, 1);
    if (ply->text)
        ply->line = malloc(count * sizeof *ply->line);
    else
        ply->place = malloc(count * sizeof *ply->place);
    if (color) ply->color = malloc(count * sizeof *ply->color);
    if (has[PLY_THICKNESS]) ply->thickness = malloc(count * sizeof *ply->thickness);
    if (!ply->position || !ply->joined || !(ply->line || ply->place) || (color && !ply->color) ||
        (has[PLY_THICKNESS] && !ply->thickness))
        reader_fail_memory(ply->reader);
}

static void set_color(Ply *ply, uint32_t v, const double values[PLY_ROLES])
{
    double most = TYPES[type_of(ply->vertices, PLY_RED)].most;
    double most_alpha = TYPES[type_of(ply->vertices, PLY_ALPHA)].most;
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
    if (!reader_ok(reader) || !check_count(ply, element)) return;
    ply->vertices = element;
    make_vertex_room(ply);
    for (uint32_t v = 0; v < element->count && reader_ok(reader); v++) {
        double values[PLY_ROLES] = {0};
        if (ply->text && reader_line_ended(reader)) reader_ended(reader);
        if (ply->text)
            ply->line[v] = reader->line;
        else
            ply->place[v] = reader->at;
        read_row(ply, element, values);
        for (int k = 0; k < 3; k++) ply->position[v][k] = (float)values[PLY_X + k];
        if (ply->color) set_color(ply, v, values);
        if (ply->thickness) ply->thickness[v] = (float)values[PLY_THICKNESS];
    }
}

static void read_strands(Ply *ply, const PlyElement *element)
{
    Reader *reader = ply->reader;
    if (!check_count(ply, element)) return;
    ply->strands = element;
    ply->sizes = malloc(((size_t)element->count + 1) * sizeof *ply->sizes);
    if (!ply->sizes) reader_fail_memory(reader);
    for (uint32_t s = 0; s < element->count && reader_ok(reader); s++) {
        double values[PLY_ROLES] = {0};
        read_row(ply, element, values);
        if (!(values[PLY_SEGMENTS] >= 0 && values[PLY_SEGMENTS] < UINT32_MAX))
            reader_fail(reader, "strand %u has %g segments", s, values[PLY_SEGMENTS]);
        ply->sizes[s] = reader_ok(reader) ? (uint32_t)values[PLY_SEGMENTS] + 1 : 0;
    }
}

static void read_edges(Ply *ply, const PlyElement *element)
{
    Reader *reader = ply->reader;
    if (!ply->vertices) reader_fail(reader, "edges before vertices");
    if (!reader_ok(reader) || !check_count(ply, element)) return;
    ply->edges = element;
    for (uint32_t e = 0; e < element->count && reader_ok(reader); e++) {
        double values[PLY_ROLES] = {0}, last = ply->vertices->count - 1.0;
        read_row(ply, element, values);
        double a = fmin(values[PLY_VERTEX1], values[PLY_VERTEX2]);
        double b = fmax(values[PLY_VERTEX1], values[PLY_VERTEX2]);
        if (!(a >= 0 && b <= last && b == a + 1))
            reader_fail(reader, "edge %u joins vertices %.0f and %.0f: expected neighbours of %u",
                        e, values[PLY_VERTEX1], values[PLY_VERTEX2], ply->vertices->count);
        if (reader_ok(reader)) ply->joined[(size_t)a] = 1;
    }
}

static void skip_element(Ply *ply, const PlyElement *element)
{
    double unused[PLY_ROLES];
    if (!check_count(ply, element) || element->property_count == 0) return;
    for (uint32_t i = 0; i < element->count && reader_ok(ply->reader); i++)
        read_row(ply, element, unused);
}

static void read_elements(Ply *ply)
{
    for (uint32_t i = 0; i < ply->element_count && reader_ok(ply->reader); i++) {
        const PlyElement *element = &ply->element[i];
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

// Meshes are refused before their bytes are read.
static void refuse_mesh(Ply *ply)
{
    for (uint32_t i = 0; i < ply->element_count && reader_ok(ply->reader); i++) {
        const PlyElement *element = &ply->element[i];
        if (element->count &&
            (strcmp(element->name, "face") == 0 || strcmp(element->name, "tristrips") == 0))
            reader_fail(ply->reader,
                        "a mesh of %u faces, not hair: meshes are for --mesh, as Wavefront OBJ",
                        element->count);
    }
}

// --- Strands.

// Those that edges make: vertices that are joined to the next one.
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
            reader_fail(ply->reader, "strands of more vertices than there are: %llu of %u",
                        (unsigned long long)end, strands->vertex_count);
        strands->first[s + 1] = (uint32_t)end;
    }
    if (reader_ok(ply->reader) && end != strands->vertex_count)
        reader_fail(ply->reader, "strands of %llu vertices in all, the file has %u",
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
        source->place[s] = ply->text ? ply->line[v] : ply->place[v];
    }
    if (!ply->text && ply->vertices->count > 1)
        source->vertex_stride = (uint32_t)(ply->place[1] - ply->place[0]);
    ply->position = NULL;
    ply->color = NULL;
    ply->thickness = NULL;
    ply->line = NULL;
}

static Result read(FormatSource *source, Reader *reader)
{
    Ply *ply = calloc(1, sizeof *ply);
    if (!ply) return reader_fail_memory(reader);
    ply->reader = reader;
    ply->source = source;
    read_header(ply);
    refuse_mesh(ply);
    read_elements(ply);
    make_strands(ply);
    if (reader_ok(reader) && !ply->text && reader_left(reader)) {
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

// The first line is "ply"; the second one says which of the two rows.
static bool match_kind(const Bytes *bytes, bool text)
{
    const char *at = (const char *)bytes->data;
    if (bytes->size < 5 || memcmp(at, "ply", 3) != 0 || !strchr(" \t\r\n", at[3])) return false;
    const char *word = strstr(at, "format");
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
