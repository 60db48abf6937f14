// SPDX-License-Identifier: MIT
// Reads Alembic files in their Ogawa form: a tree of objects, and the samples of their properties.
// Follows Alembic's own reader (lib/Alembic/Ogawa, AbcCoreOgawa, AbcGeom). A file is a tree of
// groups and data. An object's group contains its properties, its children and their headers; a
// property's group contains data for each sample that differs from the previous one.
//
// Errors go through the reader, because files are untrusted; the place is the group or data in
// question. No group of an object or its properties is read twice.
#pragma once

#include "base/reader.h"

enum { OGAWA_NAME_SIZE = 64, OGAWA_PATH_SIZE = 160 };

// Samples first .. last each differ from the previous one; all others repeat.
typedef struct OgawaProperty {
    char name[OGAWA_NAME_SIZE]; // cut; longer names are unknown anyway
    bool compound, array;
    uint32_t pod, extent;          // kind of number, and numbers per item
    uint32_t samples, first, last; // last 0: all are equal
    uint32_t sampling;             // index of the file's time sampling
    uint64_t group;
} OgawaProperty;

// The properties of a compound. A zeroed struct is empty; free with ogawa_free.
typedef struct OgawaProperties {
    OgawaProperty *property; // [count]
    uint32_t count;
} OgawaProperties;

// The times of samples: the stored times, repeated with a shift of one cycle each.
typedef struct OgawaSampling {
    double *time; // [count], ascending
    uint32_t count;
    double cycle; // s; 0: no samples after the stored ones
} OgawaSampling;

typedef struct OgawaObject {
    char path[OGAWA_PATH_SIZE]; // "/a/b"; the beginning is cut if it is too long
    char schema[OGAWA_NAME_SIZE];
    int parent; // -1: none
    uint64_t group;
    OgawaProperties own;
    bool copy; // of another object, which owns `own`
} OgawaObject;

typedef struct Ogawa {
    Reader *reader;
    OgawaObject *object; // [count], parents before their children
    int count;
    uint32_t lost_instances; // of objects that the file does not have
    double unit;             // metres, if a file of this program says so; otherwise 0
    int up_z;                // 1 or 0; -1 if the file does not say
    // --- Internal.
    OgawaSampling *sampling;
    uint32_t sampling_count;
    uint64_t texts; // data of the headers' texts
    uint8_t *seen;  // one bit for each byte offset where an object's group may begin
} Ogawa;

bool ogawa_matches(const Bytes *bytes);

// Reads the tree of objects. Close it in any case.
Result ogawa_open(Ogawa *file, Reader *reader);
void ogawa_close(Ogawa *file);

// Adds a copy of object `of` at another place of the tree, which reads the same properties. Returns
// its number; -1, and fails the reader, if memory is short.
int ogawa_add_copy(Ogawa *file, int of, int parent, const char *path);

// The properties in the compound `name` (".geom") of an object or of another compound; empty if
// there is none.
OgawaProperties ogawa_compound(Ogawa *file, const OgawaProperties *of, const char *name);
void ogawa_free(OgawaProperties *properties);

// NULL if there is none with this name.
const OgawaProperty *ogawa_find(const OgawaProperties *properties, const char *name);

// All numbers of a sample, which the caller frees. Sample 0 of a property without samples is empty;
// a sample after the last is the last. NULL after an error. Integers beyond 2^53 are rounded.
double *ogawa_numbers(Ogawa *file, const OgawaProperty *property, uint32_t sample, size_t *count);

// The texts of the first sample of a property of strings, each with its zero, one after the other,
// which the caller frees. NULL if it has none.
char *ogawa_texts(Ogawa *file, const OgawaProperty *property, size_t *count);

// The numbers per item of a geometry parameter; 0 if there is none with this name.
uint32_t ogawa_extent(Ogawa *file, const OgawaProperties *of, const char *name);

// A geometry parameter at its first sample, with its indices applied: *count numbers, `extent` per
// item. NULL if there is none with this name and extent.
double *ogawa_parameter(Ogawa *file, const OgawaProperties *of, const char *name, uint32_t extent,
                        size_t *count);

// The time (s) of a sample.
double ogawa_time(const Ogawa *file, uint32_t sampling, uint32_t sample);

// The samples (of `count`) around a time, and the weight of the second one.
double ogawa_around(const Ogawa *file, uint32_t sampling, uint32_t count, double time,
                    uint32_t *before, uint32_t *after);

// The frames of samples. Uniform samples are frames. Of samples with a cycle (several a frame, as
// for motion blur) the whole frames are: one for each cycle. Others become as many frames at even
// distances.
typedef struct OgawaFrames {
    uint32_t sampling, samples;
    uint32_t count;
    double start; // s
    double rate;  // frames per second; 0 for a single sample
} OgawaFrames;

OgawaFrames ogawa_frames(const Ogawa *file, uint32_t sampling, uint32_t count);

// The time (s) of a frame: exactly that of a sample if there is one.
double ogawa_frame_time(const Ogawa *file, const OgawaFrames *frames, uint32_t i);
