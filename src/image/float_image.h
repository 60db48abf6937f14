// SPDX-License-Identifier: MIT
// An image made ready to be measured: opaque colours as floats.
#pragma once

#include "base/error.h"
#include "image/image.h"

#include <stdbool.h>

// Colours are sRGB in levels, 0 to 255 whatever the file's depth, so that those of 8-bit images are
// exact. Those of floats are the linear values through sRGB's curve, which goes on above 1 and,
// mirrored, below 0: nothing is clipped here.
typedef struct FloatImage {
    int width, height;
    float *rgb; // [height][width][3], owned
} FloatImage;

// Reads a file by its content, PNG of 8 or 16 bits, PFM or EXR, at full depth. RESULT_BAD_INPUT
// with path and reason; RESULT_FAILED when memory is short.
Result float_image_read_image(Image *image, const char *path, Error *error);

// Lays the image over a uniform background, whose channels are all `level`; blending is in sRGB
// values, as in browsers, but of floats in light. Without alpha the background does not matter.
// RESULT_FAILED when memory is short; the float image is zeroed then.
Result float_image_create(FloatImage *floats, const Image *image, float level, Error *error);
void float_image_destroy(FloatImage *floats);

// Linear light of a level between 0 and 255; others are clamped to that.
double float_image_linear(float level);
