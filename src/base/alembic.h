// SPDX-License-Identifier: MIT
// Alembic's objects in the world: which are shown, and their transforms over time (AbcGeom's
// IXform). The file's tree and numbers are ogawa.h's.
#pragma once

#include "base/ogawa.h"

// A transform's steps, and their numbers at each sample.
typedef struct AlembicTransform {
    uint8_t step[64];
    uint32_t step_count, width, samples, sampling;
    double *value; // [samples * width]; NULL: it does nothing
    bool resets;   // what is above does not count
} AlembicTransform;

typedef struct Alembic {
    Ogawa file;
    AlembicTransform *transform; // [file.count]
    bool *hidden;                // [file.count] an object or one above it
} Alembic;

// Reads the tree of objects; fails the reader, also at transforms that are not known. In any case
// to be closed.
Result alembic_open(Alembic *alembic, Reader *reader);
void alembic_close(Alembic *alembic);

// Of samples of a property and of the transforms of an object (-1: none) and those above it: those
// of which there are most. `sampling`, `count`: in: the property's; out: these.
void alembic_longest(const Alembic *alembic, int object, uint32_t *sampling, uint32_t *count);

// From an object to the world at a time: p' = p M, acting on rows.
void alembic_matrix(const Alembic *alembic, int object, double time, double matrix[4][4]);
