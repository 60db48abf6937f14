// SPDX-License-Identifier: MIT
// Composites a block of pixels: its ribbons near to far, each under what stands before it,
// premultiplied and in linear light. Points of ribbons that are seen are shaded on the way.
#pragma once

#include "base/simd.h"
#include "lanes/block.h"
#include "lanes/project.h"
#include "lanes/shade.h"

#include <stddef.h>

// What is composited.
typedef struct Ribbons {
    const ScreenPoint *points;
    Shader shader;
    float least_seen; // share of a pixel: ribbons of which less is seen are not shaded, but look
                      // like the others; twice as much stands in for what is behind
} Ribbons;

// A thread's memory for it.
typedef struct CompositeScratch CompositeScratch;
size_t composite_scratch_size(void); // bytes; aligned to 64

// Adds `count` ribbons, those of the lower halves of `order`, near to far. Where less than
// RIBBON_LEAST_THROUGH shines through all of a cell the rest may be left out.
void composite_block(const Block *block, BlockForm form, const Ribbons *ribbons,
                     const uint64_t *order, size_t count, CompositeScratch *scratch);

// The same as a processor would that is no better than this one: the same bits.
void composite_block_on(SimdLevel level, const Block *block, BlockForm form, const Ribbons *ribbons,
                        const uint64_t *order, size_t count, CompositeScratch *scratch);
