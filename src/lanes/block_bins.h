// SPDX-License-Identifier: MIT
// Bins ribbons into the blocks of pixels that they touch: a list a block.
#pragma once

#include "base/error.h"
#include "lanes/ribbon_record.h"

#include <stddef.h>
#include <stdint.h>

// Lists of an image of columns x rows blocks of BLOCK_WIDTH x BLOCK_HEIGHT px (draw.h).
typedef struct BlockBins {
    int columns, rows;
    int parts; // ranges of ribbons that are binned at once, each by a thread
    uint32_t *
        places; // [parts][rows * columns], owned: ribbons in a block, later where the next one goes
    size_t *begins;  // [rows * columns + 1], owned: where a block's list begins
    uint64_t *pairs; // [pair_room], owned: ~depth in the upper half, the ribbon's slot in the lower
    size_t pair_room;
} BlockBins;

// RESULT_FAILED when memory is short.
Result block_bins_create(BlockBins *lists, int columns, int rows, Error *error);
void block_bins_destroy(BlockBins *lists);

// Lists the ribbons of `count` slots by ascending slots: block b's are pairs[begins[b]] to before
// pairs[begins[b + 1]]. Sorting a list by its numbers puts near ribbons first, alike ones by their
// slots. Lists do not depend on the number of threads. `records` are read only of ribbons that
// touch several blocks. RESULT_FAILED when memory is short.
Result block_bins_fill(BlockBins *lists, const RibbonKey *keys, const RibbonRecord *records,
                       size_t count, Error *error);
