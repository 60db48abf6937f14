// SPDX-License-Identifier: MIT
// Measures the difference of two images and compares it with limits, for regression tests of
// rendered images.
#pragma once

#include "base/error.h"
#include "image/float_image.h"
#include "image/mask.h"

#include <stdbool.h>
#include <stdint.h>

// Figures of a comparison that are computed only where they are needed or asked for.
enum { COMPARE_SSIM = 1, COMPARE_FLIP = 2 };

// The tolerance of a pixel and the number of pixels that may exceed it, limits for single pixels
// and small windows, and the permitted overall visual difference. Hair consists of edges, so edges
// get no special treatment.
typedef struct CompareLimits {
    bool pixels_matter;     // whether the next three are used
    double pixel_tolerance; // 0 .. 255 levels: a pixel with a larger difference of a channel fails
    double max_failing;     // number of pixels that may fail
    bool max_failing_percent; // max_failing is a percentage of the compared pixels, not a number
    bool difference_matters;  // whether the next one is used
    double max_difference;    // 0 .. 255 levels: largest permitted difference of a channel
    bool local_matters;       // whether the next one is used
    double max_local;  // 0 .. 255 levels: largest permitted mean difference of a channel over
                       // a window (pixel_sums.h)
    bool flip_matters; // whether the next one is used
    double max_flip;   // 0 .. 1: largest permitted mean of FLIP
    double pixels_per_degree; // of FLIP, 1 to 1000
    unsigned figures;         // COMPARE_...: figures to compute although no limit needs them
} CompareLimits;

// The limits that only equal images meet, with FLIP's default viewing distance.
CompareLimits compare_limits_default(void);

typedef struct CompareResult {
    int width, height;
    uint64_t compared; // pixels, without those that a mask ignores
    uint64_t failing;  // compared pixels beyond the tolerance
    double largest;    // difference of a channel, levels
    int at[2];         // the first pixel with the largest difference: x, y from the top left
    double local;      // largest mean difference of a channel over a window (pixel_sums.h), levels
    int local_at[2];   // the first window that has it: its top left pixel
    double rmse;       // over compared pixels and their red, green and blue, levels
    double psnr;       // dB, 20 log10(255 / rmse); INFINITY for equal images
    unsigned figures;  // COMPARE_...: which of the following are known
    double ssim;       // ssim.h
    double flip;       // mean of FLIP (flip.h)
    double flip_most;  // largest value of FLIP
    bool equal;        // no visible difference: `largest` is 0
    bool within;       // within the limits
} CompareResult;

// Compares what is visible. Images with alpha are composited over black and over white, and the
// worse of each figure is reported: images that agree over both agree over every background, and
// invisible colours do not count. Equal images give exactly 0 (PSNR: INFINITY, SSIM: 1). `map`, if
// not NULL, receives FLIP's error of each pixel, [height][width], the worse of both. RESULT_FAILED
// when memory is short: besides the images and the map, some MiB. Both images must have the same
// size and finite values.
//
// FLIP is computed if it has a limit, if there is a map or if limits->figures asks for it; SSIM
// only if limits->figures asks for it. For equal images both are known.
//
// With a `mask` (not NULL), no figure depends on the ignored pixels: they are treated like pixels
// beyond the border. RMSE and FLIP's mean are over compared pixels; FLIP's filters replace an
// ignored pixel by the nearest compared one; for SSIM see ssim.h. Ignored pixels are NAN in `map`.
Result compare_images(CompareResult *result, float *map, const Image *a, const Image *b,
                      const Mask *mask, const CompareLimits *limits, Error *error);

// Writes the figures in one line without a newline; returns its length like snprintf.
int compare_format(char *text, size_t size, const CompareResult *result);
