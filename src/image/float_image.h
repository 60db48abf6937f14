// SPDX-License-Identifier: MIT
// An image prepared for measuring: opaque colours as floats.
#pragma once

#include "base/error.h"
#include "image/image.h"
#include "image/image_text.h"

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

// Reads the texts of a PNG or EXR file; a PFM file has none. RESULT_BAD_INPUT or RESULT_FAILED as
// above.
Result float_image_read_texts(ImageTexts *texts, const char *path, Error *error);

// Composites the image over a uniform background whose channels are all `level`: in sRGB values, as
// in browsers, or in linear light for images of floats. Without alpha the background has no effect.
// On RESULT_FAILED (memory is short) the float image is zeroed.
Result float_image_create(FloatImage *floats, const Image *image, float level, Error *error);

// A rectangle of an image, in pixels from the top left.
typedef struct ImageArea {
    int x, y, width, height;
} ImageArea;

// The same for an area within the image. `nearest` (NULL: none) has for each pixel of the image the
// index of the pixel that stands in for it (Mask).
Result float_image_create_area(FloatImage *floats, const Image *image, const int *nearest,
                               float level, ImageArea area, Error *error);
void float_image_destroy(FloatImage *floats);

// Linear light of a level, which is clamped to 0..255.
double float_image_linear(float level);
