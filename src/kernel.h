// SPDX-License-Identifier: MIT
// Convolution of a plane of floats by kernels that are a product of one in x and one in y.
#pragma once

enum { KERNEL_MOST_RADIUS = 160 };

// Weights from -radius to radius; weight x is at [radius + x].
typedef struct Kernel {
    int radius; // 0 .. KERNEL_MOST_RADIUS
    double weights[2 * KERNEL_MOST_RADIUS + 1];
} Kernel;

// exp(-x^2 / (2 sigma^2)), sampled and scaled to the sum 1. `sigma` > 0 in pixels.
void kernel_make_gauss(Kernel *kernel, int radius, double sigma);

// Its first (order 1) or second (2) derivative, up to the sign of the first: the negative weights
// scaled to the sum -1, the positive ones to 1. radius > sigma.
void kernel_make_derivative(Kernel *kernel, int order, int radius, double sigma);

// Correlates `in` [height][width] along x or y into `out`, which must be another array; beyond the
// border lies the nearest pixel.
void kernel_apply_x(float *out, const float *in, int width, int height, const Kernel *kernel);
void kernel_apply_y(float *out, const float *in, int width, int height, const Kernel *kernel);
