// SPDX-License-Identifier: MIT
// Structural similarity: Z. Wang, A. C. Bovik, H. R. Sheikh, E. P. Simoncelli, "Image Quality
// Assessment: From Error Visibility to Structural Similarity", IEEE Transactions on Image
// Processing 13 (4), 2004.
#pragma once

#include "image/float_image.h"

// The mean SSIM index of two plates of equal size, by the luma 0.299 R + 0.587 G + 0.114 B in
// levels: exactly 1 if those are equal, else at most 1. Gaussian window of 11 x 11 pixels, sigma
// 1.5; K1 = 0.01, K2 = 0.03, L = 255; the mean is over the windows that lie within the picture,
// nothing is scaled down before. Where a side has fewer than 11 pixels the window has the largest
// odd number of them that fits. RESULT_FAILED when memory is short.
Result ssim_compare(double *ssim, const FloatImage *a, const FloatImage *b, Error *error);
