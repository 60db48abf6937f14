// SPDX-License-Identifier: MIT
// Turns ribbons into an image, block by block, on all threads.
#pragma once

#include "lanes/bins.h"
#include "lanes/composite.h"
#include "lanes/pixels.h"

// A zeroed struct is empty. Arrays of threads are owned.
typedef struct LaneRaster {
    Bins bins;
    uint64_t *sorting[PARALLEL_MOST]; // [sorting_room]
    Cell *cells[PARALLEL_MOST];       // [BLOCK_CELLS], then the depths that hide their pixels
    CompositeScratch *scratch[PARALLEL_MOST];
    size_t sorting_room;
} LaneRaster;

// Input for an image: its ribbons, and the base behind them.
typedef struct RasterScene {
    Ribbons ribbons;
    const BlockBase *base; // NULL: background only
    PixelStyle style;
    bool nearest; // nearer ribbons hide others completely, see BlockForm
    Image *image;
} RasterScene;

// Of width x height samples. RESULT_FAILED when memory is short.
Result raster_create(LaneRaster *raster, int width, int height, Error *error);
void raster_destroy(LaneRaster *raster);

// Bins the ribbons into blocks. RESULT_FAILED when memory is short.
Result raster_bin(LaneRaster *raster, const Projection *projection, Error *error);

// Composites the binned ribbons and writes all pixels of the image.
void raster_draw(LaneRaster *raster, const RasterScene *scene);
