// SPDX-License-Identifier: MIT
#include "formats/ply.h"

#include <string.h>

const PlyTypeInfo PLY_TYPE_INFO[PLY_TYPES] = {
    {"char", "int8", 1, 0},         {"uchar", "uint8", 1, 255}, {"short", "int16", 2, 0},
    {"ushort", "uint16", 2, 65535}, {"int", "int32", 4, 0},     {"uint", "uint32", 4, 0},
    {"float", "float32", 4, 0},     {"double", "float64", 8, 0}};

bool ply_matches(const Bytes *bytes)
{
    const char *at = (const char *)bytes->data;
    return bytes->size >= 5 && memcmp(at, "ply", 3) == 0 && strchr(" \t\r\n", at[3]) && at[3];
}

// --- The header, lines of words.

static void read_name(PlyFile *ply, char name[PLY_NAME_SIZE], const char *what)
{
    if (reader_ok(ply->reader) && !reader_read_word(ply->reader, name, PLY_NAME_SIZE)) {
        name[0] = 0;
        reader_fail_expected(ply->reader, what);
    }
}

static PlyType read_type(PlyFile *ply)
{
    for (int type = 0; type < PLY_TYPES; type++)
        if (reader_take(ply->reader, PLY_TYPE_INFO[type].name) ||
            reader_take(ply->reader, PLY_TYPE_INFO[type].alias))
            return (PlyType)type;
    if (reader_ok(ply->reader)) reader_fail_expected(ply->reader, "a type (float, uchar, ...)");
    return PLY_CHAR;
}

static void read_format(PlyFile *ply)
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

static void read_element(PlyFile *ply)
{
    if (ply->element_count == PLY_MOST_ELEMENTS) {
        reader_fail(ply->reader, "more than %d elements", PLY_MOST_ELEMENTS);
        return;
    }
    PlyElement *element = &ply->element[ply->element_count++];
    element->property = ply->property + ply->property_count;
    read_name(ply, element->name, "an element's name");
    element->count = reader_read_count(ply->reader, "a number of elements");
}

static void read_property(PlyFile *ply)
{
    Reader *reader = ply->reader;
    char name[PLY_NAME_SIZE] = "";
    if (ply->element_count == 0)
        reader_fail(reader, "a property before the first element: expected an element");
    if (ply->property_count == PLY_MOST_PROPERTIES)
        reader_fail(reader, "more than %d properties", PLY_MOST_PROPERTIES);
    if (!reader_ok(reader)) return;
    PlyElement *element = &ply->element[ply->element_count - 1];
    PlyProperty *property = &ply->property[ply->property_count++];
    property->list = reader_take(reader, "list");
    if (property->list) property->count_type = read_type(ply);
    if (property->list && property->count_type >= PLY_FLOAT)
        reader_fail(reader, "a list's count is a float: expected an integer");
    property->type = read_type(ply);
    read_name(ply, name, "a property's name");
    property->role = -1;
    for (int role = 0; role < ply->role_count; role++)
        if (strcmp(name, ply->roles[role]) == 0 && property->list == (role >= ply->first_list) &&
            !element->has[role])
            property->role = role;
    if (property->role >= 0) element->has[property->role] = true;
    element->property_count++;
}

// Skips to the byte after end_header and its newline, which a carriage return may precede. No other
// white space is skipped, because data may begin with any byte.
static void end_header(PlyFile *ply)
{
    Reader *reader = ply->reader;
    const uint8_t *at = reader->data + reader->at;
    size_t step = at[0] == '\n' ? 1 : at[0] == '\r' && at[1] == '\n' ? 2 : 0;
    if (step == 0 && reader_ok(reader)) reader_fail_expected(reader, "the end of the line");
    reader->at += step;
    reader->line++;
}

void ply_read_header(PlyFile *ply)
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

// Converts the bytes of a number of any type.
static double convert_bytes(const PlyFile *ply, const uint8_t *bytes, PlyType type)
{
    uint64_t bits = 0;
    uint32_t size = PLY_TYPE_INFO[type].size;
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

static double read_number(PlyFile *ply, PlyType type, bool whole)
{
    Reader *reader = ply->reader;
    if (!reader_ok(reader)) return 0;
    if (!ply->text) {
        uint32_t size = PLY_TYPE_INFO[type].size;
        if (!reader_check_array(reader, reader->at, 1, size, "the element's numbers")) return 0;
        double value = convert_bytes(ply, reader->data + reader->at, type);
        reader->at += size;
        return value;
    }
    if (reader_line_ended(reader)) reader_ended(reader);
    if (whole) return reader_read_count(reader, "a whole number from 0");
    return (double)reader_read_number(reader, "a number");
}

// Stores the first `most` numbers in `list` and skips the rest.
static uint32_t read_list(PlyFile *ply, const PlyProperty *property, uint32_t *list, uint32_t most)
{
    Reader *reader = ply->reader;
    double count = read_number(ply, property->count_type, true);
    uint32_t size = PLY_TYPE_INFO[property->type].size;
    if (count < 0) reader_fail(reader, "a list has the length %g: expected a number from 0", count);
    if (!reader_ok(reader)) return 0;
    uint64_t i = 0;
    for (; i < (uint64_t)count && (i < most || ply->text) && reader_ok(reader); i++) {
        double number = read_number(ply, property->type, most > 0 && !ply->restarts);
        if (i < most && ply->restarts && number == -1)
            list[i] = PLY_RESTART;
        else if (i < most && !(number >= 0 && number < 4294967295.0))
            reader_fail(reader, "%g in a list: expected a whole number from 0", number);
        else if (i < most)
            list[i] = (uint32_t)number;
    }
    if (!ply->text && reader_ok(reader) &&
        reader_check_array(reader, reader->at, (uint64_t)count - i, size, "a list"))
        reader->at += (size_t)((uint64_t)count - i) * size;
    return (uint32_t)count;
}

void ply_read_row_list(PlyFile *ply, const PlyElement *element, double *values, uint32_t *list,
                       uint32_t most, uint32_t *list_count)
{
    for (uint32_t i = 0; i < element->property_count && reader_ok(ply->reader); i++) {
        const PlyProperty *property = &element->property[i];
        if (property->list) {
            uint32_t count = read_list(ply, property, list, property->role >= 0 ? most : 0);
            if (property->role >= 0) *list_count = count;
            continue;
        }
        double value = read_number(ply, property->type, property->role >= ply->first_whole);
        if (property->role >= 0) values[property->role] = value;
    }
}

void ply_read_row(PlyFile *ply, const PlyElement *element, double *values)
{
    uint32_t unused;
    ply_read_row_list(ply, element, values, NULL, 0, &unused);
}

// The fewest bytes that an element takes in the file. In text, a number takes a digit and a blank.
static uint64_t least_size(const PlyFile *ply, const PlyElement *element)
{
    uint64_t size = 0;
    for (uint32_t i = 0; i < element->property_count; i++) {
        const PlyProperty *property = &element->property[i];
        size += ply->text
                    ? 2
                    : PLY_TYPE_INFO[property->list ? property->count_type : property->type].size;
    }
    return size;
}

bool ply_check_count(PlyFile *ply, const PlyElement *element)
{
    uint64_t size = least_size(ply, element), left = reader_left(ply->reader) + ply->text;
    if (size == 0 || element->count <= left / size) return true;
    reader_fail(ply->reader,
                "%u elements '%s' need at least %llu bytes, but only %zu are left in the file",
                element->count, element->name, (unsigned long long)size * element->count,
                reader_left(ply->reader));
    return false;
}

PlyType ply_type_of(const PlyElement *element, int role)
{
    for (uint32_t i = 0; i < element->property_count; i++)
        if (!element->property[i].list && element->property[i].role == role)
            return element->property[i].type;
    return PLY_FLOAT;
}
