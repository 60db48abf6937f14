// SPDX-License-Identifier: MIT
// The pixels of an image that are compared; others are ignored.
#pragma once

#include "base/error.h"
#include "image/image.h"

#include <stdbool.h>
#include <stddef.h>

typedef struct Mask {
    int width, height;
    size_t count; // compared pixels, at least 1
    // [height][width] owned: index of the nearest compared pixel, its own index if it is compared.
    int *nearest;
} Mask;

// Reads an image file. Pixels with at least half of white's luma (in sRGB levels) are compared,
// darker ones are ignored; transparent parts count as white. RESULT_BAD_INPUT with path and reason,
// also if no pixel is left to compare; RESULT_FAILED when memory is short.
Result mask_read(Mask *mask, const char *path, Error *error);

// The same for an image in memory.
Result mask_create_from(Mask *mask, const Image *image, Error *error);

// The same for `compared` [height][width]. RESULT_BAD_INPUT if none is true.
Result mask_create(Mask *mask, const bool *compared, int width, int height, Error *error);
void mask_destroy(Mask *mask);

// Whether pixel i is compared. Without a mask (NULL) all pixels are.
static inline bool mask_counts(const Mask *mask, size_t i)
{
    return !mask || (size_t)mask->nearest[i] == i;
}
