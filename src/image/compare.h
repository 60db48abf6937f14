// SPDX-License-Identifier: MIT
// How much two pictures differ, and whether that is too much: for regression tests of rendered
// images.
#pragma once

#include "base/error.h"
#include "image/image.h"

#include <stdbool.h>
#include <stdint.h>

// Knobs, apart: how far a pixel may be off, how many pixels may be off further, and how different
// the whole may look. Hair is all edges, so nothing here tries to tell edges from the rest.
typedef struct CompareLimits {
    bool pixels_matter;     // the next two count
    double pixel_tolerance; // 0 .. 255 levels: largest difference of a pixel's channel that passes
    double max_failing;     // of the pixels that may be off by more: their number, or, if
    bool max_failing_percent; // this is set, so many in a hundred
    bool flip_matters;        // the next one counts
    double max_flip;          // 0 .. 1: largest mean of FLIP
    double pixels_per_degree; // of FLIP, 1 to 1000
} CompareLimits;

// Only equal pictures match; FLIP's own distance.
CompareLimits compare_limits_default(void);

typedef struct CompareResult {
    int width, height;
    uint64_t failing; // pixels beyond the tolerance
    double largest;   // difference of a channel, levels
    int at[2];        // the first pixel with the largest difference: x, y from the top left
    double rmse;      // over all pixels and their red, green and blue, levels
    double psnr;      // dB, 20 log10(255 / rmse); INFINITY for equal pictures
    double ssim;      // ssim.h
    double flip;      // flip.h: its mean
    double flip_most; // and its largest value
    bool same;        // within the limits
} CompareResult;

// Compares what is seen: with alpha, the pictures over black and then over white, and of each
// figure the worse. What agrees over both agrees over every background; what is invisible does not
// count. Equal pictures give exactly 0 (PSNR: INFINITY, SSIM: 1). `map`, if not NULL, takes FLIP's
// error of each pixel, [height][width], in the worse case for that pixel. RESULT_FAILED when memory
// is short; the sizes must be the same.
Result compare_images(CompareResult *result, float *map, const Image *a, const Image *b,
                      const CompareLimits *limits, Error *error);

// The pixels that may fail in a picture of this size.
double compare_allowance(const CompareLimits *limits, int width, int height);

// The figures in one line without an end; returns its length as snprintf does.
int compare_format(char *text, size_t size, const CompareResult *result);
