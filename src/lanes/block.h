// SPDX-License-Identifier: MIT
// A block of pixels, which one thread composites at a time.
#pragma once

#include "glsl/draw/draw.h"

#include <stdint.h>

// A cell is the pixels that a vector holds side by side; blocks consist of cells.
enum {
    CELL_WIDTH = 2,
    CELL_HEIGHT = 4,
    CELL_PIXELS = CELL_WIDTH * CELL_HEIGHT,
    BLOCK_CELLS_ACROSS = BLOCK_WIDTH / CELL_WIDTH,
    BLOCK_CELLS = BLOCK_CELLS_ACROSS * (BLOCK_HEIGHT / CELL_HEIGHT)
};

typedef struct __attribute__((aligned(32))) Cell {
    float red[CELL_PIXELS], green[CELL_PIXELS], blue[CELL_PIXELS];
    float through[CELL_PIXELS]; // transmittance: the visible share of what is behind
} Cell;

// How ribbons hide each other. OPEN, OVER_MESH: they are blended; OVER_MESH: only before the mesh
// or floor. NEAREST: a ribbon hides everything behind it where it covers at least
// RIBBON_LEAST_COVERAGE of the pixel.
typedef enum BlockForm { BLOCK_OPEN, BLOCK_OVER_MESH, BLOCK_NEAREST, BLOCK_FORMS } BlockForm;

// Pixels at edges of the mesh, whose rims (glsl/kernel/edge.h) hide hair in a share of the pixel.
typedef struct BlockRims {
    uint8_t any[BLOCK_CELLS]; // whether the cell has a rim; otherwise its other values are not set
    float near[BLOCK_CELLS][CELL_PIXELS];     // 1/w of the rim
    float share[BLOCK_CELLS][CELL_PIXELS];    // of the pixel; 0: no rim
    float light[3][BLOCK_CELLS][CELL_PIXELS]; // of the rim, times its share
    float front[BLOCK_CELLS][CELL_PIXELS];    // transmittance of the ribbons before the rim
} BlockRims;

// A block's pixels, `cells` row by row, its first pixel's column and row.
typedef struct Block {
    Cell *cells;
    // 1/w of the opaque surface behind which nothing is visible; 0: none
    float (*hidden)[CELL_PIXELS];
    BlockRims *rims; // NULL: no rims; needed by BLOCK_OVER_MESH
    int x, y;
} Block;

// The rim of a pixel.
typedef struct BaseRim {
    uint16_t light[3]; // halves, linear, times the share
    uint16_t samples;  // of the MESH_EDGES (mesh_raster.h)
    float depth;       // 0 .. 1
} BaseRim;

enum { RIM_BITS = 16 }; // pixels whose bits a word of BlockBase.rimmed has

// Mesh and floor behind the hair, in a box of the image: its first sample x, y and its size in
// samples.
typedef struct BlockBase {
    int x, y, width, height;
    const uint16_t (*light)[4]; // [height][width] halves, linear, premultiplied
    const float *depth;         // [height][width], 0 .. 1: nothing
    // Bit k of word i of a row: pixel 16 i + k has a rim. [height][(width + 15) / 16]
    const uint16_t *rimmed;
    const BaseRim *rim; // [height][width], set where there is a rim; `light` includes its light
} BlockBase;
