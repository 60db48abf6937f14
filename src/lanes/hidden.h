// SPDX-License-Identifier: MIT
// The depth from which on hair is hidden by mesh or floor, for squares of the image. Ribbons that
// lie behind everything opaque around them are not binned.
#pragma once

#include "base/error.h"
#include "lanes/block.h"

#include <stdbool.h>

enum { HIDDEN_SQUARE = 8 }; // px

// A zeroed struct hides nothing.
typedef struct Hidden {
    int columns, rows;
    float *nearest; // [rows][columns], owned: 1/w of the farthest opaque surface in a square and
                    // the eight around it; 0: not all of them is opaque
    float *own;     // the same for the square alone
    size_t room;
    uint64_t version; // LaneBase.depth_version for which it was computed
} Hidden;

// Fills in the depths for an image of width x height px with this base. RESULT_FAILED if memory is
// short.
Result hidden_find(Hidden *hidden, const BlockBase *base, const float depth[2], int width,
                   int height, Error *error);
void hidden_destroy(Hidden *hidden);

// Whether a box of pixels (first and last column and row) is hidden. Nothing in it is nearer than
// `inverse_w` (1/w).
static inline bool hidden_hides(const Hidden *hidden, int left, int top, int right, int bottom,
                                float inverse_w)
{
    int column = (left + right) / 2 / HIDDEN_SQUARE, row = (top + bottom) / 2 / HIDDEN_SQUARE;
    return right - left < 2 * HIDDEN_SQUARE && bottom - top < 2 * HIDDEN_SQUARE &&
           column < hidden->columns && row < hidden->rows &&
           inverse_w < hidden->nearest[row * hidden->columns + column];
}
