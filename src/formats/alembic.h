// SPDX-License-Identifier: MIT
// Alembic's objects in the world: their visibility and their transforms over time (AbcGeom's
// IXform). The file's tree and numbers are read by ogawa.h.
#pragma once

#include "formats/ogawa.h"

// The matrix of an object in the world, at the time for which it was last asked.
typedef struct AlembicWorld {
    double own[4][4], matrix[4][4], time;
    bool own_known; // `own` is that of the transform, which does not change
    bool still;     // `matrix` is the same at all times
} AlembicWorld;

// The steps of a transform, and their values at each sample.
typedef struct AlembicTransform {
    uint8_t step[64];
    uint32_t step_count, width, samples, sampling;
    double *value;       // [samples * width]; NULL for the identity
    bool resets;         // parent transforms do not apply
    AlembicWorld *world; // NULL: not yet asked for
} AlembicTransform;

typedef struct Alembic {
    Ogawa file;
    AlembicTransform *transform; // [file.count]
    bool *hidden; // [file.count] hidden in all samples, by its own word or the nearest parent's
} Alembic;

// Reads the tree of objects; instances become copies of what they stand for. Fails the reader, also
// for unknown transforms. Close it in any case.
Result alembic_open(Alembic *alembic, Reader *reader);
void alembic_close(Alembic *alembic);

// Finds the longest sampling among a property and the transforms of an object (-1: none) and its
// parents. `sampling` and `count` hold the property's on input, the longest on output.
void alembic_longest(const Alembic *alembic, int object, uint32_t *sampling, uint32_t *count);

// The matrix from an object to the world at a time: p' = p M, for row vectors. Fails the reader if
// it takes too much work.
void alembic_matrix(const Alembic *alembic, int object, double time, double matrix[4][4]);
