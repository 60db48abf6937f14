// SPDX-License-Identifier: MIT
// Composites a block of pixels: its ribbons near to far, each under what stands before it,
// premultiplied and in linear light.
#pragma once

#include "base/simd.h"
#include "glsl/draw/draw.h"
#include "lanes/ribbon_record.h"

#include <stddef.h>

// Pixels side by side in a vector; blocks consist of such cells.
enum {
    CELL_WIDTH = 2,
    CELL_HEIGHT = 4,
    CELL_PIXELS = CELL_WIDTH * CELL_HEIGHT,
    BLOCK_CELLS_ACROSS = BLOCK_WIDTH / CELL_WIDTH,
    BLOCK_CELLS = BLOCK_CELLS_ACROSS * (BLOCK_HEIGHT / CELL_HEIGHT)
};

typedef struct __attribute__((aligned(32))) Cell {
    float red[CELL_PIXELS], green[CELL_PIXELS], blue[CELL_PIXELS];
    float through[CELL_PIXELS]; // share of what stands behind that is seen
} Cell;

// Ribbons become visible where they stand before what hides them, or: a ribbon that covers a pixel
// by LEAST_COVERAGE hides all behind it.
typedef enum BlockForm { BLOCK_OPEN, BLOCK_OVER_MESH, BLOCK_NEAREST, BLOCK_FORMS } BlockForm;

// A block's pixels, `cells` row by row, its first pixel's column and row.
typedef struct Block {
    Cell *cells;
    float (*hidden)[CELL_PIXELS]; // 1/w of what hides all behind it; 0: nothing
    int x, y;
} Block;

// Adds `count` ribbons, those of the lower halves of `order`, near to far. Where less than 1/1024
// shines through all of a cell the rest may be left out.
void block_composite(const Block *block, BlockForm form, const RibbonRecord *records,
                     const uint64_t *order, size_t count);

// The same as a processor would that is no better than this one: the same bits.
void block_composite_on(SimdLevel level, const Block *block, BlockForm form,
                        const RibbonRecord *records, const uint64_t *order, size_t count);
