// SPDX-License-Identifier: MIT
// Transforms of USD prims (UsdGeomXformable): the operations listed in xformOpOrder, whose values
// may be animated. Matrices are for row vectors, p' = p M, as in USD.
#pragma once

#include "formats/usd_text.h"

// The values of an operation over time. They are interpolated linearly (orientations spherically)
// and constant before the first and after the last time, as in USD.
typedef struct UsdTrack {
    double *time;  // [count]; a value without time has count 1 and `timed` false
    double *value; // [count * width]
    size_t count, room;
    uint32_t width;
    bool timed;
} UsdTrack;

typedef struct UsdOp {
    char name[USD_WORD_SIZE]; // "xformOp:translate:pivot"
    UsdTrack track;
    uint32_t line;
} UsdOp;

typedef struct UsdTransform {
    UsdOp *op;
    size_t op_count;
    char (*order)[USD_WORD_SIZE]; // may begin with "!invert!"; "!resetXformStack!"
    const UsdOp **named;          // [order_count], found when first evaluated; NULL if unknown
    size_t order_count;
    uint32_t line; // line of the order; 0 if there is none, and operations have no effect
    bool still;    // no operation of the order changes; set when first evaluated
} UsdTransform;

// Reads the value of "xformOp:..." (with ".timeSamples" if `timed`), or of xformOpOrder.
void usd_transform_read_op(UsdTransform *transform, Reader *reader, const char *name, bool timed);
void usd_transform_read_order(UsdTransform *transform, Reader *reader);
void usd_transform_destroy(UsdTransform *transform);

// The number of operations in the order that have no value; they are identities.
uint32_t usd_transform_count_empty(const UsdTransform *transform);

// Computes the matrix at a time; `reset`: parent transforms do not apply. Fails the reader for
// unknown operations, and if a requested inverse does not exist.
void usd_transform_evaluate(UsdTransform *transform, Reader *reader, double time,
                            double matrix[4][4], bool *reset);

// to = a b
void usd_transform_multiply(double to[4][4], double a[4][4], double b[4][4]);
