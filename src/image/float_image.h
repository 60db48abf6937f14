// SPDX-License-Identifier: MIT
// An image prepared for measuring: opaque colours as floats.
#pragma once

#include "base/error.h"
#include "image/image.h"

#include <stdbool.h>

// Colours are sRGB in levels from 0 to 255, for any bit depth of the file, so 8-bit images are
// exact. Linear floats go through sRGB's curve, which is extended above 1 and mirrored below 0;
// nothing is clipped.
typedef struct FloatImage {
    int width, height;
    float *rgb; // [height][width][3], owned
} FloatImage;

// Reads a file at full depth; its content decides between PNG (8 or 16 bits), PFM, EXR
// and Radiance .hdr.
// RESULT_BAD_INPUT with path and reason; RESULT_FAILED when memory is short.
Result float_image_read_image(Image *image, const char *path, Error *error);

// Composites the image over a uniform background whose channels are all `level`: in sRGB values, as
// in browsers, or in linear light for images of floats. Without alpha the background has no effect.
// On RESULT_FAILED (memory is short) the float image is zeroed.
Result float_image_create(FloatImage *floats, const Image *image, float level, Error *error);
void float_image_destroy(FloatImage *floats);

// Linear light of a level, which is clamped to 0..255.
double float_image_linear(float level);
