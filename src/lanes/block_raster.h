// SPDX-License-Identifier: MIT
// From ribbons to an image, block by block, on all threads.
#pragma once

#include "base/parallel.h"
#include "lanes/block_bins.h"
#include "lanes/block_pixels.h"

// A zeroed struct is empty.
typedef struct BlockRaster {
    BlockBins lists;
    uint64_t *sorting[PARALLEL_MOST]; // [sorting_room], owned: each thread's
    Cell *cells[PARALLEL_MOST];       // [BLOCK_CELLS], owned: each thread's
    size_t sorting_room;
} BlockRaster;

// An image: its ribbons, and what they are composited with.
typedef struct BlockScene {
    const RibbonKey *keys;       // [slots]
    const RibbonRecord *records; // [slots]
    size_t slots;
    const BlockBase *base; // NULL: nothing
    PixelStyle style;
    bool nearest; // ribbons hide what is behind them, see BlockForm
    Image *image;
} BlockScene;

// Of width x height samples. RESULT_FAILED when memory is short.
Result block_raster_create(BlockRaster *raster, int width, int height, Error *error);
void block_raster_destroy(BlockRaster *raster);

// Bins the ribbons into blocks. Returns in *touched how many blocks they touch, each counted.
// RESULT_FAILED when memory is short.
Result block_raster_bin(BlockRaster *raster, const BlockScene *scene, uint64_t *touched,
                        Error *error);

// Composites what was binned and writes all pixels of the image.
void block_raster_composite(BlockRaster *raster, const BlockScene *scene);
