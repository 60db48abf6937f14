// SPDX-License-Identifier: MIT
// A block's pixels before and after its ribbons are composited.
#pragma once

#include "image/image.h"
#include "lanes/block.h"

#include <stdbool.h>

// How light becomes colours of the image.
typedef struct PixelStyle {
    int samples;      // per pixel side: 1, 2 or 4
    int tone;         // Tone or TONE_LIGHT
    bool shows_depth; // shows the nearest ribbon's or mesh's distance in m instead of light: 1 at
                      // depth_range[0], 0 at [1]; if these are equal: m
    float depth_range[2];
    float background[4]; // light, premultiplied, and opacity
    float backing[4];    // the colour under the tone-mapped image: linear RGB, and 1; all 0: none
    float depth[2];      // clip z = x * w + y
} PixelStyle;

// Clears a block: no ribbons yet, and hidden only by the base. NULL: no base in this block.
void pixels_clear(const Block *block, const BlockBase *base, const PixelStyle *style);

// Whether a part of the base lies in the block that begins at x, y.
bool pixels_have_base(const BlockBase *base, int x, int y);

// Writes those pixels of the block that lie in the image, of 3 or 4 channels. NULL base: no base in
// this block.
void pixels_store(const Block *block, const BlockBase *base, const PixelStyle *style,
                  const Image *image);
