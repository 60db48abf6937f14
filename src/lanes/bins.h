// SPDX-License-Identifier: MIT
// Sorts ribbons into the blocks of pixels that they touch: one list for each block.
#pragma once

#include "lanes/project.h"

// The lists of an image of columns x rows blocks of BLOCK_WIDTH x BLOCK_HEIGHT px (draw.h).
typedef struct Bins {
    int columns, rows;
    int part_room;    // largest number of parts of a projection: the threads when it was created
    uint32_t *places; // [parts][rows * columns], owned: number of ribbons in a block, later the
                      // position of its next ribbon
    size_t *begins;   // [rows * columns + 1], owned: start of each block's list
    uint64_t *pairs; // [pair_room], owned: ~depth in the upper half, the ribbon's slot in the lower
    size_t pair_room;
    size_t longest; // length of the longest list
} Bins;

// RESULT_FAILED when memory is short.
Result bins_create(Bins *bins, int columns, int rows, Error *error);
void bins_destroy(Bins *bins);

// Lists all ribbons by ascending slots. The list of block b is pairs[begins[b]] up to, not
// including, pairs[begins[b + 1]]. If a list is sorted by its numbers, near ribbons come first, and
// ribbons of equal depth are in the order of their slots. The lists do not depend on the number of
// threads. RESULT_FAILED if memory is short.
Result bins_fill(Bins *bins, const Projection *projection, Error *error);

static inline size_t bins_count(const Bins *bins)
{
    return (size_t)bins->columns * (size_t)bins->rows;
}
