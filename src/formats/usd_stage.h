// SPDX-License-Identifier: MIT
// Reads a `.usda` layer: its unit, axis and rate, and all prims in the order of the file with their
// transforms and visibility. A schema for curves or meshes reads the attributes. References,
// inherits and specializes within the layer are followed: the prim repeats what it names. Sublayers
// and arcs to other files, and variants, are refused on prims that may hold what the schema reads,
// because ignoring them would give another scene; elsewhere they are counted.
#pragma once

#include "formats/usd_samples.h"
#include "formats/usd_times.h"
#include "formats/usd_transform.h"

enum { USD_PATH_SIZE = 256 };

// For messages: how to flatten a file of several layers.
extern const char USD_FLATTEN[];

// The matrix of a prim in the world, at the time for which it was last asked.
typedef struct UsdWorld {
    double matrix[4][4], time;
    bool still; // it is the same at all times
} UsdWorld;

// Purposes of materials, the more specific first.
typedef enum UsdPurpose { USD_FOR_PHYSICS, USD_FOR_ALL, USD_PURPOSES } UsdPurpose;

typedef struct UsdPrim {
    int parent; // -1: none
    UsdTransform transform;
    UsdWorld *world;              // NULL: not yet asked for
    uint64_t path;                // hash of its path
    char name[32];                // cut
    uint64_t bound[USD_PURPOSES]; // hashes of the paths of its materials; 0: none
    bool hidden;                  // invisible in all samples, or of purpose guide or proxy
    bool absent;                  // inactive or abstract (class, over)
    bool instancer, sealed; // sealed: of a type that can't hold the schema's prims, nor can what is
                            // below it
    bool skinned;           // a skeleton moves it, and what is below it
    const char *arc;        // word of an arc that was not followed; NULL: none
    uint32_t arc_line;
    bool copy;  // of another prim, which owns the transform
    bool timed; // usd_stage_add_times has its times
} UsdPrim;

// `to` is the schema's data; an object is what the schema makes of a prim.
typedef struct UsdSchema {
    const char *type; // of the prims that it reads
    // Creates an object for a prim of this type; NULL if the schema does not handle it, or if
    // memory is short.
    void *(*begin)(void *to, const char *type, int prim);
    // Reads the value of an attribute and returns true; for others reads nothing and returns false.
    // `name` has `length` characters without ".timeSamples". *rate: where its interpolation is
    // stored.
    bool (*read)(void *to, void *object, const char *name, size_t length, bool samples,
                 char (**rate)[16]);
    // Where to store a number of the prim's metadata; NULL: nowhere.
    float *(*find_number)(void *object, const char *word);
    // Takes the object of a prim that is complete; its path is stage->path.
    void (*end)(void *to, void *object);
    // Repeats the object of prim `of`, if it has one, as prim `prim`.
    void (*repeat)(void *to, int of, int prim, const char *path);
} UsdSchema;

// A prim that repeats another one of the layer.
typedef struct UsdArc {
    int prim;
    uint64_t source; // hash of a path
    const char *word;
    uint32_t line, depth;
    char path[USD_PATH_SIZE]; // of the prim
} UsdArc;

typedef struct UsdStage {
    Reader *reader;
    const UsdSchema *schema;
    void *to;
    UsdPrim *prim; // [prim_count]
    int prim_count;
    char path[USD_PATH_SIZE]; // of the prim that is being read
    UsdArc *arc;              // [arc_count]
    uint32_t arc_count;
    uint32_t skipped_arcs; // that were not followed, on prims that hold nothing of the schema
    float unit;            // m
    float mass_unit;       // kg
    bool up_z;
    double codes_per_second, frames_per_second; // 0 if the file does not say
} UsdStage;

bool usd_stage_matches(const Bytes *bytes);

// Fails the reader. Destroy the stage in any case.
Result usd_stage_read(UsdStage *stage, Reader *reader, const UsdSchema *schema, void *to);
void usd_stage_destroy(UsdStage *stage);

// Time codes per second.
double usd_stage_rate(const UsdStage *stage);

// Whether the prim or a parent is hidden, is absent, belongs to a PointInstancer, or is moved by a
// skeleton.
bool usd_stage_hides(const UsdStage *stage, int prim);
bool usd_stage_lacks(const UsdStage *stage, int prim);
bool usd_stage_instances(const UsdStage *stage, int prim);
bool usd_stage_skins(const UsdStage *stage, int prim);

// The hash of the path of the material for physics: that bound to the prim or its nearest parent
// for this purpose, otherwise for all purposes; 0: none. Compare it with UsdPrim.path.
uint64_t usd_stage_find_material(const UsdStage *stage, int prim);

// The number of transforms without effect, because xformOpOrder is missing.
uint32_t usd_stage_count_idle(const UsdStage *stage);

// The number of operations of transforms without a value, which are identities.
uint32_t usd_stage_count_empty(const UsdStage *stage);

// A prim's matrix at a time code, including its parents: p' = p M. Fails the reader.
void usd_stage_find_matrix(const UsdStage *stage, int prim, double time, double matrix[4][4]);

// Adds the times of the samples and of the transforms that move them, each transform's once.
void usd_stage_add_times(UsdStage *stage, int prim, const UsdSamples *samples, UsdTimes *times);
