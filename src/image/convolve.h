// SPDX-License-Identifier: MIT
// Convolution of a plane of floats with separable kernels.
#pragma once

#include <stdbool.h>

enum { CONVOLVE_MOST_RADIUS = 160 };

// Weights from -radius to radius; weight x is at [radius + x].
typedef struct ConvolveKernel {
    int radius;         // 0 .. CONVOLVE_MOST_RADIUS
    bool is_derivative; // the weights sum to 0
    double weights[2 * CONVOLVE_MOST_RADIUS + 1];
} ConvolveKernel;

// exp(-x^2 / (2 sigma^2)), sampled and scaled to the sum 1. `sigma` > 0 in pixels.
void convolve_make_gauss(ConvolveKernel *kernel, int radius, double sigma);

// The first (order 1) or second (2) derivative of the Gaussian; the sign of the first is arbitrary.
// Negative weights are normalised to the sum -1, positive ones to 1. radius > sigma.
void convolve_make_derivative(ConvolveKernel *kernel, int order, int radius, double sigma);

// Correlates `in` [height][width] along x or y into `out`, which must be a different array; pixels
// beyond the border repeat the nearest pixel. Sums are floats: they err by about a rounding of the
// largest difference from the middle pixel.
void convolve_apply_x(float *out, const float *in, int width, int height,
                      const ConvolveKernel *kernel);
void convolve_apply_y(float *out, const float *in, int width, int height,
                      const ConvolveKernel *kernel);
