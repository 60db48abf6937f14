// SPDX-License-Identifier: MIT
// A ribbon as glsl/draw/block_project.comp writes it and as the block rasteriser reads it.
#pragma once

#include <stdint.h>

// One line of a CPU's cache; see glsl/draw/block.glsl for how shape and tint are packed. The
// ribbon's middle line moves by `slope` px from row to row, and its strip reaches so far to either
// side of where that line crosses a row's middle. First and last row and column whose pixels'
// middles it may touch.
typedef struct RibbonRecord {
    float a[2], b[2]; // ends, px
    uint32_t shape[4], tint[4];
    float slope, reach;
    uint32_t rows, columns; // px: first | last << 16
} RibbonRecord;

// Where its slot's ribbon is to be looked for.
typedef struct RibbonKey {
    uint32_t depth;  // 1/w in its middle, a positive float's bits; 0: there is no ribbon
    uint32_t blocks; // bytes: first column and row, last column and row of blocks in its box; or
                     // MANY_BLOCKS
} RibbonKey;
