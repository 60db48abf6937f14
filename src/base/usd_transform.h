// SPDX-License-Identifier: MIT
// Transforms of USD prims (UsdGeomXformable): the operations that xformOpOrder names, with values
// that may change with time. Matrices act on rows, p' = p M, as in USD.
#pragma once

#include "base/usd_text.h"

// The numbers of an operation, at one time or at several. Between two times they are interpolated
// linearly (orientations spherically), before and behind them they stay, as USD has it.
typedef struct UsdTrack {
    double *time;        // [count]; a value without a time has count 1 and `timed` false
    double (*value)[16]; // [count]
    size_t count, room;
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
    size_t order_count;
    uint32_t line; // of the order; 0: there is none, and operations have no effect
} UsdTransform;

// Reads the value of "xformOp:..." (with ".timeSamples" if `timed`), or of xformOpOrder.
void usd_transform_read_op(UsdTransform *transform, Reader *reader, const char *name, bool timed);
void usd_transform_read_order(UsdTransform *transform, Reader *reader);
void usd_transform_destroy(UsdTransform *transform);

// Makes the matrix at a time; `reset`: those of the parents do not count. Fails the reader at
// operations that it does not know or that are not there, and where an inverse is asked for and
// there is none.
void usd_transform_evaluate(const UsdTransform *transform, Reader *reader, double time,
                            double matrix[4][4], bool *reset);

// to = a b
void usd_transform_multiply(double to[4][4], double a[4][4], double b[4][4]);
