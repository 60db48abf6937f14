// SPDX-License-Identifier: MIT
// A block's pixels between the image and what ribbons are composited in.
#pragma once

#include "image/image.h"
#include "lanes/block.h"

#include <stdbool.h>

// How pixels become colours.
typedef struct PixelStyle {
    int samples;      // across a pixel: 1, 2 or 4
    int tone;         // Tone or TONE_LIGHT
    bool shows_depth; // of the nearest ribbon or mesh, m, in place of light: 1 at depth_range[0],
                      // 0 at [1]; alike: m
    float depth_range[2];
    float background[4]; // light, premultiplied, and opacity
    float depth[2];      // clip z = x * w + y
} PixelStyle;

// Nothing before the base, nor anything of it hidden; NULL: there is none in this block.
void pixels_clear(const Block *block, const BlockBase *base, const PixelStyle *style);

// Whether some of the base lies in the block that begins at x, y.
bool pixels_have_base(const BlockBase *base, int x, int y);

// Writes the block's pixels to the image of 3 or 4 channels, as far as they lie in it. NULL base:
// none in this block.
void pixels_store(const Block *block, const BlockBase *base, const PixelStyle *style,
                  const Image *image);
