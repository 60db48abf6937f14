// SPDX-License-Identifier: MIT
// Which pixels of an image are compared, and which are ignored.
#pragma once

#include "base/error.h"
#include "image/image.h"

#include <stdbool.h>
#include <stddef.h>

typedef struct Mask {
    int width, height;
    size_t count; // of pixels that are compared, at least 1
    int *nearest; // [height][width], owned: index of the nearest pixel that is compared, its own if
                  // it is one itself
} Mask;

// Reads an image file: pixels of at least half of white's luma (sRGB levels) are compared, darker
// ones are ignored; what is transparent counts as white. RESULT_BAD_INPUT with path and reason,
// also if no pixel is left to compare; RESULT_FAILED when memory is short.
Result mask_read(Mask *mask, const char *path, Error *error);

// The same of an image in memory.
Result mask_create_from(Mask *mask, const Image *image, Error *error);

// The same from pixels: `compared` [height][width]. RESULT_BAD_INPUT if none is true.
Result mask_create(Mask *mask, const bool *compared, int width, int height, Error *error);
void mask_destroy(Mask *mask);

// Whether pixel i is compared; all are without a mask (NULL).
static inline bool mask_counts(const Mask *mask, size_t i)
{
    return !mask || (size_t)mask->nearest[i] == i;
}
