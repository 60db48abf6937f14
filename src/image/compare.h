// SPDX-License-Identifier: MIT
// How much two images differ, and whether that is too much: for regression tests of rendered
// images.
#pragma once

#include "base/error.h"
#include "image/float_image.h"
#include "image/mask.h"

#include <stdbool.h>
#include <stdint.h>

// How far a pixel may be off, how many pixels may be off further, and how different the whole may
// look. Hair is all edges, so edges are not treated apart.
typedef struct CompareLimits {
    bool pixels_matter;     // the next three count
    double pixel_tolerance; // 0 .. 255 levels: largest difference of a pixel's channel that passes
    double max_failing;     // how many pixels may be off by more
    bool max_failing_percent; // max_failing is a percentage of the compared pixels, not a number
    bool flip_matters;        // the next one counts
    double max_flip;          // 0 .. 1: largest mean of FLIP
    double pixels_per_degree; // of FLIP, 1 to 1000
} CompareLimits;

// Only equal images match; FLIP's own distance.
CompareLimits compare_limits_default(void);

typedef struct CompareResult {
    int width, height;
    uint64_t compared; // pixels: all but those that a mask ignores
    uint64_t failing;  // of them, those beyond the tolerance
    double largest;    // difference of a channel, levels
    int at[2];         // the first pixel with the largest difference: x, y from the top left
    double rmse;       // over compared pixels and their red, green and blue, levels
    double psnr;       // dB, 20 log10(255 / rmse); INFINITY for equal images
    double ssim;       // compare_ssim
    double flip;       // flip.h: its mean
    double flip_most;  // and its largest value
    bool same;         // within the limits
} CompareResult;

// Compares what is seen: with alpha, the images over black and then over white, and of each figure
// the worse. What agrees over both agrees over every background; what is invisible does not count.
// Equal images give exactly 0 (PSNR: INFINITY, SSIM: 1). `map`, if not NULL, takes FLIP's error of
// each pixel, [height][width], in the worse case for that pixel. RESULT_FAILED when memory is
// short; the sizes must be the same.
//
// No figure depends on the pixels that `mask` ignores, if it is not NULL: they are treated as what
// lies beyond the border. RMSE and FLIP's mean are over compared pixels; FLIP's filters see the
// nearest compared pixel instead of an ignored one; for SSIM see below. In `map` they are NAN.
Result compare_images(CompareResult *result, float *map, const Image *a, const Image *b,
                      const Mask *mask, const CompareLimits *limits, Error *error);

// The mean index of structural similarity (Z. Wang, A. C. Bovik, H. R. Sheikh, E. P. Simoncelli,
// "Image Quality Assessment: From Error Visibility to Structural Similarity", IEEE Transactions on
// Image Processing 13 (4), 2004) of two images of equal size, by the luma 0.299 R + 0.587 G +
// 0.114 B in levels: exactly 1 if those are equal, else at most 1. Gaussian window of 11 x 11
// pixels, sigma 1.5; K1 = 0.01, K2 = 0.03, L = 255; over the windows within the image, without
// downscaling. Where a side has fewer than 11 pixels the window has the largest odd number that
// fits. With a mask a window's moments are over its compared pixels, with their weights scaled to
// the sum 1, and the mean over windows is weighted by that sum before. RESULT_FAILED when memory is
// short.
Result compare_ssim(double *ssim, const FloatImage *a, const FloatImage *b, const Mask *mask,
                    Error *error);

// The figures in one line without an end; returns its length as snprintf does.
int compare_format(char *text, size_t size, const CompareResult *result);
