// SPDX-License-Identifier: MIT
// The block rasteriser: strands are projected and shaded in compute, and what becomes of them is
// dealt out to blocks of pixels and composited there by the program's own threads. For drivers on
// CPUs, where it is several times as fast as ribbons that are drawn as triangles into an A-buffer.
#pragma once

#include "draw/block_raster.h"
#include "draw/picture.h"
#include "draw/render_behind.h"
#include "draw/render_cull.h"
#include "gpu/gpu_timer.h"
#include "sim/hair.h"

#include <stdbool.h>

// What stands behind and among the hair. No target: nothing.
typedef struct BlocksBase {
    CullBase cull;
    uint64_t version; // another one whenever light or depth has changed, from 1 on
    const int *box;   // samples: x, y lowest, highest; outside there is background
    float depth[2];   // clip z = x * w + y
} BlocksBase;

typedef struct RenderBlocks {
    LookPrograms project;
    RenderCull cull;
    RenderBehind behind;
    BlockRaster raster;
    PixelStyle style;
    bool nearest;            // ribbons hide what is behind them
    GpuBuffer ribbons, keys; // RibbonRecord, RibbonKey: one a slot
    GpuBuffer counts, material;
    const GpuLimits *limits;
    BlocksBase base;                    // of the picture
    size_t slots;                       // of the picture
    bool skips;                         // many strands of the last picture could be left out
    uint64_t strands;                   // of the picture
    uint64_t touched, segments, culled; // blocks that ribbons touch, each counted
} RenderBlocks;

// `limits` outlives the blocks.
Result render_blocks_create(RenderBlocks *blocks, const GpuLimits *limits,
                            const RendererOptions *options, Error *error);
void render_blocks_destroy(RenderBlocks *blocks);

// Begins a picture of at most `segments` ribbons with `base` before and among them, which must stay
// until it is drawn. Needs the DrawParams block. RESULT_FAILED if memory is short or there are 2^32
// segments.
Result render_blocks_begin(RenderBlocks *blocks, uint64_t segments, const BlocksBase *base,
                           Error *error);

// Adds a batch. Needs the DrawParams block. RESULT_FAILED if the look's shader does not compile.
Result render_blocks_add(RenderBlocks *blocks, const HairBatch *batch, const Look *look,
                         Error *error);

// Draws all that was added into `image`. No ribbon is lost: lists are counted before they are made.
// RESULT_FAILED if memory is short.
Result render_blocks_draw(RenderBlocks *blocks, GpuTimer *timer, Image *image, Error *error);
