// SPDX-License-Identifier: MIT
// The block-list rasteriser: in compute and on the CPU, for drivers on CPUs, where it is several
// times as fast as ribbons that are drawn as triangles into an A-buffer. Every ribbon is dealt out
// to the lists of the blocks of pixels that it touches, near to far, and each block is composited
// by itself.
#pragma once

#include "block_lists.h"
#include "gpu_timer.h"
#include "hair.h"
#include "radix.h"
#include "render_cull.h"
#include "render_picture.h"
#include "render_target.h"

#include <stdbool.h>

typedef struct RenderBlocks {
    LookPrograms project;
    RenderCull cull;
    GLuint composite[2];     // over the background, over a mesh
    GpuBuffer ribbons, keys; // see block.glsl
    GpuBuffer numbers, jobs; // see block_lists.h
    GpuBuffer counts, pixels, material;
    const GpuLimits *limits;
    Radix radix;
    BlockLists lists;
    uint32_t *order; // [order_room], owned: ribbons near to far
    size_t order_room;
    int width, height;                  // of the samples
    int samples;                        // across a pixel
    ImageKind kind;                     // of the picture
    Aov aov;                            // that is drawn instead of light
    uint32_t background[4];             // pixels without hair: four words of them
    int tone;                           // display.glsl's macro
    int64_t most_numbers;               // in all lists of a band
    size_t slots, seen;                 // records there is room for; that are seen
    bool skips;                         // many strands of the last picture could be left out
    uint64_t strands;                   // of the picture
    uint64_t touched, segments, culled; // blocks that ribbons touch, each counted
    uint32_t bands;
} RenderBlocks;

// Whether a picture of these options fits into the driver's buffers.
bool render_blocks_can_store(const GpuLimits *limits, const RendererOptions *options);

// `limits` outlives the blocks.
Result render_blocks_create(RenderBlocks *blocks, const GpuLimits *limits,
                            const RendererOptions *options, Error *error);
void render_blocks_destroy(RenderBlocks *blocks);

// Makes what drawing over a mesh or a floor needs; nothing if it is there.
Result render_blocks_add_base(RenderBlocks *blocks, Error *error);

// Whether so many ribbons fit into the driver's buffers.
bool render_blocks_can_hold(const GpuLimits *limits, uint64_t segments);

// Begins a picture of at most `segments` ribbons (render_blocks_can_hold) with `base` before and
// among them. Needs the DrawParams block.
Result render_blocks_begin(RenderBlocks *blocks, uint64_t segments, const CullBase *base,
                           Error *error);

// Adds a batch. Needs the DrawParams block. RESULT_FAILED if the look's shader does not compile.
Result render_blocks_add(RenderBlocks *blocks, const HairBatch *batch, const Look *look,
                         Error *error);

// Sorts, deals out and composites all that was added, over the target's base and behind its depth
// if `over_mesh`. What has no hair is background, but for `box` (samples: x, y lowest, highest),
// where the mesh stands. No ribbon is lost: lists are counted before they are made, and a picture
// whose lists are too long for a buffer is drawn in bands.
// RESULT_FAILED if memory is short or a single row of blocks needs more than there can be.
Result render_blocks_draw(RenderBlocks *blocks, const RenderTarget *target, bool over_mesh,
                          const int box[4], GpuTimer *timer, Error *error);

// Whether a block had more ribbons than CPU drivers let a shader's loop visit. Waits.
bool render_blocks_fell_short(const RenderBlocks *blocks);

// Copies the picture into `image`; waits for it.
void render_blocks_read(const RenderBlocks *blocks, Image *image);
