// SPDX-License-Identifier: MIT
// PLY's elements and numbers, text and binary of both byte orders. After Greg Turk's "The PLY
// Polygon File Format" (1994). Who reads a kind of file names the properties that it wants; all
// others are stepped over.
#pragma once

#include "base/reader.h"

enum { PLY_MOST_ELEMENTS = 32, PLY_MOST_PROPERTIES = 256, PLY_NAME_SIZE = 40, PLY_MOST_ROLES = 16 };

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

// What a type is: its size in bytes, and the largest of an unsigned one that may be a colour's; 0:
// the colour would be linear.
typedef struct PlyTypeInfo {
    const char *name, *alias;
    uint32_t size;
    double most;
} PlyTypeInfo;

extern const PlyTypeInfo PLY_TYPE_INFO[PLY_TYPES];

typedef struct PlyProperty {
    PlyType type, count_type; // of a list's elements and of their number
    bool list;
    int role; // which of the reader's names it has; -1: stepped over
} PlyProperty;

typedef struct PlyElement {
    char name[PLY_NAME_SIZE];
    uint32_t count, property_count;
    PlyProperty *property; // of the file's
    bool has[PLY_MOST_ROLES];
} PlyElement;

typedef struct PlyFile {
    Reader *reader;
    // What is wanted: names of properties, the last ones of which are lists and whole numbers.
    const char *const *roles;
    int role_count, first_whole, first_list;
    bool text, big; // big: most significant byte first
    PlyElement element[PLY_MOST_ELEMENTS];
    PlyProperty property[PLY_MOST_PROPERTIES];
    uint32_t element_count, property_count;
} PlyFile;

// Whether the first line is that of a PLY file.
bool ply_matches(const Bytes *bytes);

// Reads the header; `reader` and roles are set. Then the reader stands at the first element, in
// text with its line.
void ply_read_header(PlyFile *ply);

// Fails unless the file can hold so many of the element.
bool ply_check_count(PlyFile *ply, const PlyElement *element);

// One element of its kind: the numbers that have a role go to `values`, [role_count]. Lists are
// stepped over, but that of a role: at most `most` whole numbers of it go to `list`, their number
// to *list_count, which may be larger.
void ply_read_row(PlyFile *ply, const PlyElement *element, double *values);
void ply_read_row_list(PlyFile *ply, const PlyElement *element, double *values, uint32_t *list,
                       uint32_t most, uint32_t *list_count);

// Of the element's property of this role; PLY_FLOAT if it has none.
PlyType ply_type_of(const PlyElement *element, int role);
