// SPDX-License-Identifier: MIT
// Measures the difference of two images and compares it with limits, for regression tests of
// rendered images.
#pragma once

#include "base/error.h"
#include "image/float_image.h"
#include "image/mask.h"

#include <stdbool.h>
#include <stdint.h>

// The tolerance of a pixel, the number of pixels that may exceed it, and the permitted overall
// visual difference. Hair consists of edges, so edges get no special treatment.
typedef struct CompareLimits {
    bool pixels_matter;       // whether the next three are used
    double pixel_tolerance;   // 0 .. 255 levels: largest permitted difference of a channel
    double max_failing;       // number of pixels that may exceed the tolerance
    bool max_failing_percent; // max_failing is a percentage of the compared pixels, not a number
    bool flip_matters;        // whether the next one is used
    double max_flip;          // 0 .. 1: largest permitted mean of FLIP
    double pixels_per_degree; // of FLIP, 1 to 1000
} CompareLimits;

// The limits that only equal images meet, with FLIP's default viewing distance.
CompareLimits compare_limits_default(void);

typedef struct CompareResult {
    int width, height;
    uint64_t compared; // pixels, without those that a mask ignores
    uint64_t failing;  // compared pixels beyond the tolerance
    double largest;    // difference of a channel, levels
    int at[2];         // the first pixel with the largest difference: x, y from the top left
    double rmse;       // over compared pixels and their red, green and blue, levels
    double psnr;       // dB, 20 log10(255 / rmse); INFINITY for equal images
    double ssim;       // compare_ssim
    double flip;       // mean of FLIP (flip.h)
    double flip_most;  // largest value of FLIP
    bool same;         // within the limits
} CompareResult;

// Compares what is visible. Images with alpha are composited over black and over white, and the
// worse of each figure is reported: images that agree over both agree over every background, and
// invisible colours do not count. Equal images give exactly 0 (PSNR: INFINITY, SSIM: 1). `map`, if
// not NULL, receives FLIP's error of each pixel, [height][width], the worse of both. RESULT_FAILED
// when memory is short. Both images must have the same size.
//
// With a `mask` (not NULL), no figure depends on the ignored pixels: they are treated like pixels
// beyond the border. RMSE and FLIP's mean are over compared pixels; FLIP's filters replace an
// ignored pixel by the nearest compared one; for SSIM see below. Ignored pixels are NAN in `map`.
Result compare_images(CompareResult *result, float *map, const Image *a, const Image *b,
                      const Mask *mask, const CompareLimits *limits, Error *error);

// The mean structural similarity (Z. Wang, A. C. Bovik, H. R. Sheikh, E. P. Simoncelli, "Image
// Quality Assessment: From Error Visibility to Structural Similarity", IEEE Transactions on Image
// Processing 13 (4), 2004) of two images of equal size, from the luma 0.299 R + 0.587 G + 0.114 B
// in levels: exactly 1 if the lumas are equal, otherwise at most 1. Gaussian window of 11 x 11
// pixels, sigma 1.5; K1 = 0.01, K2 = 0.03, L = 255; over all windows within the image, without
// downscaling. If a side has fewer than 11 pixels, the window has the largest odd size that fits.
// With a mask, a window's moments are over its compared pixels, with weights normalised to 1, and
// the mean over windows is weighted by the sum before normalisation. RESULT_FAILED when memory is
// short.
Result compare_ssim(double *ssim, const FloatImage *a, const FloatImage *b, const Mask *mask,
                    Error *error);

// Writes the figures in one line without a newline; returns its length like snprintf.
int compare_format(char *text, size_t size, const CompareResult *result);
