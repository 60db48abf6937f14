// SPDX-License-Identifier: MIT
// The mean structural similarity (Z. Wang, A. C. Bovik, H. R. Sheikh, E. P. Simoncelli, "Image
// Quality Assessment: From Error Visibility to Structural Similarity", IEEE Transactions on Image
// Processing 13 (4), 2004) of two images of equal size, from the luma 0.299 R + 0.587 G + 0.114 B
// in levels: exactly 1 if the lumas are equal, otherwise at most 1. Gaussian window of 11 x 11
// pixels, sigma 1.5; K1 = 0.01, K2 = 0.03, L = 255; over all windows within the image, without
// downscaling. If a side has fewer than 11 pixels, the window has the largest odd size that fits.
// With a mask, a window's moments are over its compared pixels, with weights normalised to 1, and
// the mean over windows is weighted by the sum before normalisation.
#pragma once

#include "base/error.h"
#include "image/convolve.h"
#include "image/float_image.h"
#include "image/mask.h"

// The computation goes through the rows of the images from top to bottom and keeps those of one
// window.
typedef struct Ssim {
    int width, height, row; // row: the next one to add
    const Mask *mask;       // NULL: none
    ConvolveKernel kx, ky;
    double *memory;     // of the moments below, owned
    double sum, shares; // over the windows so far
} Ssim;

// RESULT_FAILED when memory is short. A zeroed struct may be destroyed.
Result ssim_create(Ssim *ssim, int width, int height, const Mask *mask, Error *error);
void ssim_destroy(Ssim *ssim);

// Adds the next rows of both images, which are as wide as they were said to be.
void ssim_add(Ssim *ssim, const FloatImage *a, const FloatImage *b);

// The mean, once all rows have been added.
double ssim_mean(const Ssim *ssim);

// All at once.
Result ssim_compare(double *mean, const FloatImage *a, const FloatImage *b, const Mask *mask,
                    Error *error);
