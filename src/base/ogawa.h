// SPDX-License-Identifier: MIT
// Reads Alembic files in their Ogawa form: objects in a tree, and the samples of their properties.
// After Alembic's own reader (lib/Alembic/Ogawa, AbcCoreOgawa, AbcGeom). A file
// is a tree of groups and data: an object's group holds its properties, its children and their
// headers; a property's group holds data for each sample that differs from the one before.
//
// Failing goes through the reader, as with all outside bytes; its place is the group or data that
// is wrong. No group of an object or of its properties is read twice, and all samples together may
// take at most 64 times the file's bytes (and 64 MB), so that a small file takes neither time nor
// memory.
#pragma once

#include "base/reader.h"

enum { OGAWA_NAME_SIZE = 64, OGAWA_PATH_SIZE = 160 };

// Samples first .. last differ from the one before each, all others repeat.
typedef struct OgawaProperty {
    char name[OGAWA_NAME_SIZE]; // cut: a longer one is none that is known
    bool compound, array;
    uint32_t pod, extent;          // kind of number, and how many make an item
    uint32_t samples, first, last; // last 0: all are alike
    uint32_t sampling;             // which of the file's
    uint64_t group;
} OgawaProperty;

// The properties of a compound. A zeroed one is empty; free with ogawa_free.
typedef struct OgawaProperties {
    OgawaProperty *property; // [count]
    uint32_t count;
} OgawaProperties;

// The times of samples: those stored, again and again, a cycle later each time.
typedef struct OgawaSampling {
    double *time; // [count], rising
    uint32_t count;
    double cycle; // s; 0: there are no samples behind those stored
} OgawaSampling;

typedef struct OgawaObject {
    char path[OGAWA_PATH_SIZE]; // "/a/b"; cut in front where it is longer
    char schema[OGAWA_NAME_SIZE];
    int parent; // -1: none
    uint64_t group;
    OgawaProperties own;
} OgawaObject;

typedef struct Ogawa {
    Reader *reader;
    OgawaObject *object; // [count], parents before their children
    int count;
    double unit; // metres, as a file of this program says; 0: it does not
    int up_z;    // 1, 0, or -1 where it does not say
    // --- Its own.
    OgawaSampling *sampling;
    uint32_t sampling_count;
    uint64_t texts; // data of the headers' texts
    uint8_t *seen;  // a bit for each byte that groups of objects begin at
    double budget;  // bytes that samples may still take
} Ogawa;

bool ogawa_matches(const Bytes *bytes);

// Reads the tree of objects. In any case to be closed.
Result ogawa_open(Ogawa *file, Reader *reader);
void ogawa_close(Ogawa *file);

// The properties in the compound `name` of an object (".geom") or of a compound's; empty where
// there is none. Each only once.
OgawaProperties ogawa_compound(Ogawa *file, const OgawaProperties *of, const char *name);
void ogawa_free(OgawaProperties *properties);

// NULL: there is none of this name.
const OgawaProperty *ogawa_find(const OgawaProperties *properties, const char *name);

// All numbers of a sample, to be freed; sample 0 of a property without samples has none, a number
// behind the last is the last one's. NULL after failing. Whole numbers beyond 2^53 are rounded.
double *ogawa_numbers(Ogawa *file, const OgawaProperty *property, uint32_t sample, size_t *count);

// A property of a geometry's parameters at its first sample, with its indices where it has some:
// *count numbers, `extent` for each item; NULL where there is none of this name and extent.
double *ogawa_parameter(Ogawa *file, const OgawaProperties *of, const char *name, uint32_t extent,
                        size_t *count);

// The time (s) of a sample.
double ogawa_time(const Ogawa *file, uint32_t sampling, uint32_t sample);

// Which samples of `count` lie around a time, and the second one's share.
double ogawa_around(const Ogawa *file, uint32_t sampling, uint32_t count, double time,
                    uint32_t *before, uint32_t *after);

// The times at which samples are looked at: theirs if they are even, else as many at even
// distances. The rate: samples a second, 0 for one alone.
double ogawa_even_time(const Ogawa *file, uint32_t sampling, uint32_t count, uint32_t i);
double ogawa_rate(const Ogawa *file, uint32_t sampling, uint32_t count);

// Whether `vertices` positions in each of `samples` samples may be made from a file of this size;
// if not, fails the reader. Samples of transforms are small, and each moves all vertices.
bool ogawa_allows(const Ogawa *file, uint64_t samples, uint64_t vertices);
