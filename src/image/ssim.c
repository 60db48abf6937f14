// SPDX-License-Identifier: MIT
#include "image/ssim.h"

#include "image/convolve.h"

#include <stdlib.h>

enum { WINDOW = 11, MOMENTS = 5 };

static const double SIGMA = 1.5, C1 = (0.01 * 255) * (0.01 * 255), C2 = (0.03 * 255) * (0.03 * 255);

static double luma(const FloatImage *plate, size_t i)
{
    const float *rgb = plate->rgb + 3 * i;
    return 0.299 * (double)rgb[0] + 0.587 * (double)rgb[1] + 0.114 * (double)rgb[2];
}

static int fit_radius(int side)
{
    return side >= WINDOW ? WINDOW / 2 : (side - 1) / 2;
}

// Equations (13) and (6) of the paper, at the window around x, y: weighted means, variances and
// covariance. In double, as variances are differences of large numbers.
static double index_at(const double (*lumas)[2], int width, int x, int y, const ConvolveKernel *kx,
                       const ConvolveKernel *ky)
{
    double sums[MOMENTS] = {0}; // of a, b, aa, bb, ab
    for (int j = -ky->radius; j <= ky->radius; ++j)
        for (int i = -kx->radius; i <= kx->radius; ++i) {
            const double *l = lumas[(size_t)(y + j) * (size_t)width + (size_t)(x + i)];
            double w = kx->weights[kx->radius + i] * ky->weights[ky->radius + j];
            double wa = w * l[0], wb = w * l[1];
            sums[0] += wa, sums[1] += wb;
            sums[2] += wa * l[0], sums[3] += wb * l[1], sums[4] += wa * l[1];
        }
    double aa = sums[0] * sums[0], bb = sums[1] * sums[1], ab = sums[0] * sums[1];
    return (2 * ab + C1) * (2 * (sums[4] - ab) + C2) /
           ((aa + bb + C1) * ((sums[2] - aa) + (sums[3] - bb) + C2));
}

Result ssim_compare(double *ssim, const FloatImage *a, const FloatImage *b, Error *error)
{
    ConvolveKernel kx, ky;
    size_t count = (size_t)a->width * (size_t)a->height;
    double(*lumas)[2] = malloc(count * sizeof *lumas), sum = 0;
    if (!lumas) return error_set(error, RESULT_FAILED, "no memory for the SSIM of two pictures");
    for (size_t i = 0; i < count; ++i) lumas[i][0] = luma(a, i), lumas[i][1] = luma(b, i);
    convolve_make_gauss(&kx, fit_radius(a->width), SIGMA);
    convolve_make_gauss(&ky, fit_radius(a->height), SIGMA);
    int columns = a->width - 2 * kx.radius, rows = a->height - 2 * ky.radius;
    for (int y = 0; y < rows; ++y)
        for (int x = 0; x < columns; ++x)
            sum += index_at((const double(*)[2])lumas, a->width, x + kx.radius, y + ky.radius, &kx,
                            &ky);
    *ssim = sum / ((double)columns * rows);
    free(lumas);
    return RESULT_OK;
}
