// SPDX-License-Identifier: MIT
#include "image/convolve.h"

#include <assert.h>
#include <math.h>
#include <stdbool.h>
#include <stddef.h>

void convolve_make_gauss(ConvolveKernel *kernel, int radius, double sigma)
{
    double sum = 0;
    assert(radius >= 0 && radius <= CONVOLVE_MOST_RADIUS);
    kernel->radius = radius;
    for (int x = -radius; x <= radius; ++x) sum += exp(-x * x / (2 * sigma * sigma));
    for (int x = -radius; x <= radius; ++x)
        kernel->weights[radius + x] = exp(-x * x / (2 * sigma * sigma)) / sum;
}

static double derivative(int order, int x, double sigma)
{
    double s2 = sigma * sigma, gauss = exp(-x * x / (2 * s2));
    return order == 1 ? x * gauss : (x * x / s2 - 1) * gauss;
}

void convolve_make_derivative(ConvolveKernel *kernel, int order, int radius, double sigma)
{
    double positive = 0, negative = 0;
    assert(radius > sigma && radius <= CONVOLVE_MOST_RADIUS);
    kernel->radius = radius;
    for (int x = -radius; x <= radius; ++x) {
        double weight = derivative(order, x, sigma);
        *(weight > 0 ? &positive : &negative) += fabs(weight);
    }
    for (int x = -radius; x <= radius; ++x) {
        double weight = derivative(order, x, sigma);
        kernel->weights[radius + x] = weight / (weight > 0 ? positive : negative);
    }
}

static int clamp(int value, int most)
{
    return value < 0 ? 0 : value > most ? most : value;
}

void convolve_apply_x(float *out, const float *in, int width, int height,
                      const ConvolveKernel *kernel)
{
    int radius = kernel->radius;
    const double *weights = kernel->weights + radius;
    for (int y = 0; y < height; ++y, in += width, out += width)
        for (int x = 0; x < width; ++x) {
            bool inside = x >= radius && x + radius < width;
            double sum = 0;
            for (int k = -radius; k <= radius; ++k)
                sum += weights[k] * (double)in[inside ? x + k : clamp(x + k, width - 1)];
            out[x] = (float)sum;
        }
}

// A row is processed in pieces whose sums stay in the first-level cache.
void convolve_apply_y(float *out, const float *in, int width, int height,
                      const ConvolveKernel *kernel)
{
    enum { PIECE = 64 };
    int radius = kernel->radius;
    for (int y = 0; y < height; ++y)
        for (int begin = 0; begin < width; begin += PIECE) {
            double sums[PIECE] = {0};
            int count = width - begin < PIECE ? width - begin : PIECE;
            for (int k = -radius; k <= radius; ++k) {
                double weight = kernel->weights[radius + k];
                const float *row = in + (size_t)clamp(y + k, height - 1) * (size_t)width + begin;
                for (int i = 0; i < count; ++i) sums[i] += weight * (double)row[i];
            }
            float *to = out + (size_t)y * (size_t)width + begin;
            for (int i = 0; i < count; ++i) to[i] = (float)sums[i];
        }
}
