// SPDX-License-Identifier: MIT
// Composites a block of pixels: adds its ribbons from near to far, each under those before it,
// premultiplied and in linear light. End points of ribbons that are seen are shaded on the way.
#pragma once

#include "base/simd.h"
#include "lanes/block.h"
#include "lanes/project.h"
#include "lanes/shade.h"

#include <stddef.h>

// The ribbons of an image.
typedef struct Ribbons {
    const ScreenPoint *points;
    Shader shader;
    float least_seen; // share of a pixel: ribbons of which less is visible are not shaded but get
                      // the colour of the others, up to 7 % of the pixel's hair; twice that
                      // share may be added for what is behind
} Ribbons;

// The memory that a thread needs.
typedef struct CompositeScratch CompositeScratch;
size_t composite_scratch_size(void); // bytes; aligned to 64

// Adds `count` ribbons from near to far; their numbers are the lower halves of `order`. The rest
// may be left out of a cell once less than RIBBON_LEAST_THROUGH is seen through each of its pixels.
void composite_block(const Block *block, BlockForm form, const Ribbons *ribbons,
                     const uint64_t *order, size_t count, CompositeScratch *scratch);

// The same with the code for an older processor; it gives the same bits. For tests.
void composite_block_on(SimdLevel level, const Block *block, BlockForm form, const Ribbons *ribbons,
                        const uint64_t *order, size_t count, CompositeScratch *scratch);
