// SPDX-License-Identifier: MIT
// Differences of two images pixel by pixel, in levels of 0 to 255, and of small windows.
#pragma once

#include "base/error.h"
#include "image/image.h"
#include "image/mask.h"

#include <stdint.h>

// Windows of SUMS_WINDOW x SUMS_WINDOW pixels, at every half of that.
enum { SUMS_WINDOW = 16 };

typedef struct PixelSums {
    uint64_t failing; // pixels with a channel that differs by more than the tolerance
    double squares;   // sum over red, green and blue of all pixels
    double largest;   // difference of a channel
    int at[2];        // the first pixel that has it: x, y from the top left
    // The largest mean difference of a channel over a window, with its sign: rounding makes some
    // pixels lighter and others darker, which cancels; a hair, a shadow or a colour does not.
    double local;
    int local_at[2]; // top left of the first window that has it
} PixelSums;

// Sums over the pixels that the mask compares (NULL: all); others, and pixels beyond the border,
// count as equal. Images with alpha are composited over a background of `level`
// (float_image_create). RESULT_FAILED when memory is short.
Result pixel_sums_find(PixelSums *sums, const Image *a, const Image *b, const Mask *mask,
                       float level, double tolerance, Error *error);
