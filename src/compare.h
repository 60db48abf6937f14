// SPDX-License-Identifier: MIT
// How much two pictures differ: for regression tests of rendered images.
#pragma once

#include "error.h"
#include "image.h"

#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>

// Two knobs, apart: how far a pixel may be off, and how many pixels may be off further. Both 0:
// only equal pictures match. Hair is all edges, so nothing here tries to tell edges from the rest.
typedef struct CompareLimits {
    int level; // 0 .. 255: largest difference of a channel at which a pixel still counts as equal
    double share; // 0 .. 1: of all pixels, that may differ by more
} CompareLimits;

typedef struct CompareResult {
    uint64_t pixels, over; // in all, and beyond the level
    int largest;           // difference of a channel, 0 .. 255
    int at[2];             // the first pixel with the largest difference: x, y from the top left
    double rms;            // over all pixels and channels, in levels; exactly 0 for equal pictures
    bool match;            // over <= share * pixels
} CompareResult;

// Compares channel by channel; of pictures with alpha the colours are multiplied by it first, so
// that what can't be seen does not count. A picture without alpha is opaque. RESULT_FAILED if the
// sizes differ.
Result compare_images(CompareResult *result, const Image *a, const Image *b,
                      const CompareLimits *limits, Error *error);

// One line with all figures and both limits.
void compare_print(const CompareResult *result, const CompareLimits *limits, FILE *stream);
