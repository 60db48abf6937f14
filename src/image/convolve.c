// SPDX-License-Identifier: MIT
#include "image/convolve.h"

#include "base/simd.h"

#include <assert.h>
#include <math.h>
#include <stdbool.h>
#include <stddef.h>

void convolve_make_gauss(ConvolveKernel *kernel, int radius, double sigma)
{
    double sum = 0;
    assert(radius >= 0 && radius <= CONVOLVE_MOST_RADIUS);
    kernel->radius = radius;
    kernel->is_derivative = false;
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
    kernel->is_derivative = true;
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

// One call of convolve_apply_x or convolve_apply_y.
typedef struct Pass {
    float *out;
    const float *in;
    int width, height;
    const ConvolveKernel *kernel;
} Pass;

// Outputs that are summed together, in registers.
enum { PIECE = 32, MOST_TAPS = 2 * CONVOLVE_MOST_RADIUS + 1 };

SIMD_INLINE void take_weights(float weights[MOST_TAPS], const ConvolveKernel *kernel)
{
    for (int k = 0; k <= 2 * kernel->radius; ++k) weights[k] = (float)kernel->weights[k];
}

SIMD_INLINE void add_tap(float sums[PIECE], float weight, const float *from, const float *middle,
                         int count)
{
    if (count == PIECE) // a loop of a constant length
        for (int i = 0; i < PIECE; ++i) sums[i] += weight * (from[i] - middle[i]);
    else
        for (int i = 0; i < count; ++i) sums[i] += weight * (from[i] - middle[i]);
}

SIMD_INLINE void finish(float *out, const float sums[PIECE], const float *middle, int count,
                        const ConvolveKernel *kernel)
{
    float share = kernel->is_derivative ? 0 : 1; // the sum of the weights
    for (int i = 0; i < count; ++i) out[i] = sums[i] + share * middle[i];
}

// The sums are of differences from the middle pixel, so that they err by the rounding of these and
// not of the pixels: equal pixels have derivatives of exactly 0. Where the taps of a piece would
// reach beyond the row, they read a copy that is extended.
SIMD_INLINE void sum_x(const Pass *pass, int part)
{
    float weights[MOST_TAPS], row[PIECE + MOST_TAPS];
    int radius = pass->kernel->radius, width = pass->width;
    (void)part;
    take_weights(weights, pass->kernel);
    for (int y = 0; y < pass->height; ++y)
        for (int begin = 0; begin < width; begin += PIECE) {
            float sums[PIECE] = {0};
            const float *in = pass->in + (size_t)y * (size_t)width, *from = in + begin - radius;
            int count = width - begin < PIECE ? width - begin : PIECE;
            if (begin < radius || begin + count + radius > width) {
                for (int i = 0; i < count + 2 * radius; ++i)
                    row[i] = in[clamp(begin + i - radius, width - 1)];
                from = row;
            }
            const float *middle = from + radius;
            for (int k = 0; k <= 2 * radius; ++k)
                add_tap(sums, weights[k], from + k, middle, count);
            finish(pass->out + (size_t)y * (size_t)width + begin, sums, middle, count,
                   pass->kernel);
        }
}

SIMD_INLINE void sum_y(const Pass *pass, int part)
{
    float weights[MOST_TAPS];
    int radius = pass->kernel->radius, width = pass->width;
    (void)part;
    take_weights(weights, pass->kernel);
    for (int y = 0; y < pass->height; ++y)
        for (int begin = 0; begin < width; begin += PIECE) {
            float sums[PIECE] = {0};
            int count = width - begin < PIECE ? width - begin : PIECE;
            const float *in = pass->in + begin, *middle = in + (size_t)y * (size_t)width;
            for (int k = 0; k <= 2 * radius; ++k) {
                int row = clamp(y + k - radius, pass->height - 1);
                add_tap(sums, weights[k], in + (size_t)row * (size_t)width, middle, count);
            }
            finish(pass->out + (size_t)y * (size_t)width + begin, sums, middle, count,
                   pass->kernel);
        }
}

SIMD_CALL(sum_x, Pass)
SIMD_CALL(sum_y, Pass)

void convolve_apply_x(float *out, const float *in, int width, int height,
                      const ConvolveKernel *kernel)
{
    call_sum_x(&(Pass){out, in, width, height, kernel});
}

void convolve_apply_y(float *out, const float *in, int width, int height,
                      const ConvolveKernel *kernel)
{
    call_sum_y(&(Pass){out, in, width, height, kernel});
}
