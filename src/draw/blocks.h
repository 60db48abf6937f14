// SPDX-License-Identifier: MIT
// The block rasteriser: strands are projected and shaded in compute, and their ribbons are binned
// into blocks of pixels and composited there by the program's own threads. For drivers on
// CPUs, where it is several times as fast as ribbons that are drawn as triangles into an A-buffer.
#pragma once

#include "draw/drawing.h"
#include "gpu/gpu_timer.h"
#include "lanes/block_raster.h"
#include "lanes/ribbon_store.h"
#include "passes/cull.h"
#include "sim/hair.h"

#include <stdbool.h>

enum { BLOCKS_MOST_SLOTS = 1 << 21 }; // 151 MB

// What stands behind and among the hair. No target: nothing.
typedef struct BlocksBase {
    CullBase cull;
    uint64_t version; // another one whenever light or depth has changed, from 1 on
    const int *box;   // samples: x, y lowest, highest; outside there is background
    float depth[2];   // clip z = x * w + y
} BlocksBase;

// What stands behind and among the hair, read back from the driver.
typedef struct BlocksBehind {
    BlockBase base;
    uint16_t (*light)[4]; // [room], owned
    float *depth;         // [room], owned
    size_t room;
    uint64_t version; // of what was read; 0: nothing was
} BlocksBehind;

typedef struct Blocks {
    LookPrograms project;
    Cull cull;
    BlocksBehind behind;
    BlockRaster raster;
    PixelStyle style;
    bool nearest;            // ribbons hide what is behind them
    GpuBuffer ribbons, keys; // RibbonRecord, RibbonKey: one a slot
    GpuBuffer counts;
    // An image of more than most_slots moves its ribbons to `store`, stored_slots at a time.
    size_t most_slots, stored_slots;
    RibbonStore store;
    const GpuLimits *limits;
    BlocksBase base;                    // of the image
    bool stores;                        // this image has more slots
    size_t slots;                       // of the image in the driver's buffers
    bool skips;                         // many strands of the last image could be left out
    uint64_t strands;                   // of the image
    uint64_t touched, segments, culled; // blocks that ribbons touch, each counted
} Blocks;

// `limits` outlives the blocks.
Result blocks_create(Blocks *blocks, const GpuLimits *limits, const RendererOptions *options,
                     Error *error);
void blocks_destroy(Blocks *blocks);

// Begins an image of at most `segments` ribbons with `base` before and among them, which must stay
// until it is drawn. Needs the DrawParams block. RESULT_FAILED if memory is short or there are 2^32
// segments.
Result blocks_begin(Blocks *blocks, uint64_t segments, const BlocksBase *base, Error *error);

// Adds a batch. Needs the DrawParams block. RESULT_FAILED if the look's shader does not compile.
Result blocks_add(Blocks *blocks, const HairBatch *batch, const Look *look, Error *error);

// Takes what the buffers `counts` and, if strands were looked through, `cull.tally` have come to;
// NULL: they were not.
void blocks_take_counts(Blocks *blocks, const uint32_t *counts, const uint32_t *tally);

// Counts what was added: segments, culled. Waits for it. RESULT_FAILED if it can't be read.
Result blocks_count(Blocks *blocks, Error *error);

// Draws all that was added into `image`. No ribbon is lost: lists are counted before they are made.
// RESULT_FAILED if memory is short.
Result blocks_draw(Blocks *blocks, GpuTimer *timer, Image *image, Error *error);
