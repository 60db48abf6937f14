// SPDX-License-Identifier: MIT
// Deals ribbons out to the blocks of pixels that they touch: a list a block, near to far.
#pragma once

#include "error.h"
#include "parallel.h"

#include <stddef.h>
#include <stdint.h>

enum { JOB_GROUP = 8 }; // jobs that are composited side by side

// A ribbon's record as shaders write and read it (glsl/block.glsl); what matters here is the span.
// In blocks, whose middles lie at whole numbers: the ribbon's middle line moves by `slope` columns
// from row to row, and its strip reaches so far to either side of where that line crosses a row's
// middle. First and last row and column that it touches.
typedef struct RibbonRecord {
    float a[2], b[2]; // ends, px
    uint32_t shape[4], tint[4];
    float slope, reach;
    uint32_t rows, columns; // first | last << 16
} RibbonRecord;

// What a lane composites: a block (row by row), and which of all the numbers are its list.
typedef struct BlockJob {
    uint32_t block, begin, count, unused;
} BlockJob;

// Lists of a picture of columns x rows blocks of `width` x `height` px. Ribbons are dealt out by
// several threads, each a range of them: lists do not depend on how many.
typedef struct BlockLists {
    int columns, rows;
    float width, height;
    int parts;
    uint32_t
        *places; // [parts][rows * columns], owned: ribbons in a block, later where the next goes
    BlockJob *jobs, *sorted;                 // [rows * columns + JOB_GROUP], owned
    size_t ends[PARALLEL_MOST], part_groups; // groups of jobs: before a part's end, in the largest
} BlockLists;

// RESULT_FAILED when memory is short.
Result block_lists_create(BlockLists *lists, int columns, int rows, float width, float height,
                          Error *error);
void block_lists_destroy(BlockLists *lists);

// Counts what the `count` ribbons of `order` touch, before lists are made of the same ones. Returns
// the sum.
uint64_t block_lists_count(BlockLists *lists, const RibbonRecord *ribbons, const uint32_t *order,
                           size_t count);

// The end of the most rows from `row` on whose lists have at most `most` numbers in all, which goes
// to *size; `row` itself if it alone has more.
int block_lists_fit(const BlockLists *lists, int row, uint64_t most, uint64_t *size);

// Finds the jobs of rows row .. end - 1: blocks with a list, and those in `box` (columns and rows,
// x, y lowest, highest). They come in groups of JOB_GROUP whose lists have similar lengths,
// near each other in the picture, and in as many parts of equal work and size as there are threads:
// drivers on CPUs give each thread one such part of a dispatch. Returns how many jobs there are
// with those that fill up groups and parts. Once a picture for each row.
size_t block_lists_place(BlockLists *lists, int row, int end, const int box[4]);

// Writes the jobs of the last block_lists_place. Those that fill up have no list, and the block
// columns * rows.
void block_lists_write_jobs(const BlockLists *lists, BlockJob *jobs);

// Writes the lists of those rows, numbers of ribbons in the order of `order`, after
// block_lists_place.
void block_lists_fill(BlockLists *lists, const RibbonRecord *ribbons, const uint32_t *order,
                      size_t count, int row, int end, uint32_t *numbers);
