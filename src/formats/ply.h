// SPDX-License-Identifier: MIT
// Elements and numbers of PLY files, text and binary in both byte orders. After Greg Turk's "The
// PLY Polygon File Format" (1994). The reader of a kind of file names the properties that it wants;
// all others are skipped.
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

// A type: its size in bytes, and the largest value of an unsigned type that may hold a colour; 0:
// such a colour is linear.
typedef struct PlyTypeInfo {
    const char *name, *alias;
    uint32_t size;
    double most;
} PlyTypeInfo;

extern const PlyTypeInfo PLY_TYPE_INFO[PLY_TYPES];

typedef struct PlyProperty {
    PlyType type, count_type; // of a list's elements and of their number
    bool list;
    int role; // index of its name in the reader's roles; -1 if skipped
} PlyProperty;

typedef struct PlyElement {
    char name[PLY_NAME_SIZE];
    uint32_t count, property_count;
    PlyProperty *property; // properties of the file
    bool has[PLY_MOST_ROLES];
} PlyElement;

#define PLY_RESTART UINT32_MAX

typedef struct PlyFile {
    Reader *reader;
    // The wanted properties by name; integers and lists come last.
    const char *const *roles;
    int role_count, first_whole, first_list;
    bool text, big; // big-endian
    bool restarts;  // -1 in a list becomes PLY_RESTART
    PlyElement element[PLY_MOST_ELEMENTS];
    PlyProperty property[PLY_MOST_PROPERTIES];
    uint32_t element_count, property_count;
} PlyFile;

// Whether the first line is that of a PLY file.
bool ply_matches(const Bytes *bytes);

// Reads the header; `reader` and the roles must be set. Then the reader is at the first element, in
// text at its line.
void ply_read_header(PlyFile *ply);

// Fails unless the file can hold as many of the element as it declares.
bool ply_check_count(PlyFile *ply, const PlyElement *element);

// Reads one element: numbers with a role go to `values`, [role_count]. Lists are skipped, except
// the list with a role: at most `most` of its integers go to `list`, and their total number to
// *list_count.
void ply_read_row(PlyFile *ply, const PlyElement *element, double *values);
void ply_read_row_list(PlyFile *ply, const PlyElement *element, double *values, uint32_t *list,
                       uint32_t most, uint32_t *list_count);

// The type of the element's property with this role; PLY_FLOAT if it has none.
PlyType ply_type_of(const PlyElement *element, int role);
