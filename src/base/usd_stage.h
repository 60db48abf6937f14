// SPDX-License-Identifier: MIT
// Reads a `.usda` layer: its unit, axis and rate, and all prims in the order of the file, with
// their transforms and what hides them (inactive, invisible, abstract: class, over; of purpose
// guide or proxy). Attributes are read by a schema: that of curves, that of meshes. What would
// bring in other files or choose among versions (sublayers, references, variants, ...) is refused,
// since passing over it would give another scene.
#pragma once

#include "base/usd_samples.h"
#include "base/usd_times.h"
#include "base/usd_transform.h"

// How a file of several layers becomes one, for messages.
extern const char USD_FLATTEN[];

typedef struct UsdPrim {
    int parent; // -1: none
    UsdTransform transform;
    bool hidden, abstract, instancer;
} UsdPrim;

// `to` is the schema's own, and an object what it makes of a prim.
typedef struct UsdSchema {
    // An object for a prim of this type; NULL: it is none of the schema's, or memory is short.
    void *(*begin)(void *to, const char *type, int prim);
    // Reads the value of an attribute and returns true; false, with nothing read, for others.
    // `name`, of `length` characters without ".timeSamples". *rate: where its interpolation goes.
    bool (*read)(void *to, void *object, const char *name, size_t length, bool samples,
                 char (**rate)[16]);
    // Where a number of the prim's metadata goes; NULL: nowhere.
    float *(*find_number)(void *object, const char *word);
    // Takes the object, whose prim is whole.
    void (*end)(void *to, void *object);
} UsdSchema;

typedef struct UsdStage {
    Reader *reader;
    const UsdSchema *schema;
    void *to;
    UsdPrim *prim; // [prim_count]
    int prim_count;
    float unit; // m
    bool up_z;
    double codes_per_second, frames_per_second; // 0: the file does not say
} UsdStage;

bool usd_stage_matches(const Bytes *bytes);

// Fails the reader. The stage is to be destroyed in any case.
Result usd_stage_read(UsdStage *stage, Reader *reader, const UsdSchema *schema, void *to);
void usd_stage_destroy(UsdStage *stage);

// Time codes a second.
double usd_stage_rate(const UsdStage *stage);

// Whether the prim or one above it is hidden, or a PointInstancer's.
bool usd_stage_hides(const UsdStage *stage, int prim);
bool usd_stage_instances(const UsdStage *stage, int prim);

// Transforms that have no effect, for want of an order.
uint32_t usd_stage_count_idle(const UsdStage *stage);

// A prim's matrix at a time code, with those above it: p' = p M. Fails the reader.
void usd_stage_find_matrix(const UsdStage *stage, int prim, double time, double matrix[4][4]);

// The times of the samples and of the transforms that move them.
void usd_stage_add_times(const UsdStage *stage, int prim, const UsdSamples *samples,
                         UsdTimes *times);
