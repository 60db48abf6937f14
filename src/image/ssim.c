// SPDX-License-Identifier: MIT
#include "image/ssim.h"

#include "base/simd.h"

#include <stdlib.h>
#include <string.h>

// The weights of the compared pixels, and a, b, aa, bb, ab. In double, because a variance is a
// small difference of large numbers.
enum { WINDOW = 11, MOMENTS = 6 };

static const double SIGMA = 1.5, C1 = (0.01 * 255) * (0.01 * 255), C2 = (0.03 * 255) * (0.03 * 255);

static int fit_radius(int side)
{
    return side >= WINDOW ? WINDOW / 2 : (side - 1) / 2;
}

Result ssim_create(Ssim *ssim, int width, int height, const Mask *mask, Error *error)
{
    *ssim = (Ssim){.width = width, .height = height, .mask = mask};
    ssim->memory = malloc((size_t)width * MOMENTS * (WINDOW + 2) * sizeof *ssim->memory);
    if (!ssim->memory)
        return error_set(error, RESULT_FAILED, "no memory for the SSIM of two images");
    convolve_make_gauss(&ssim->kx, fit_radius(width), SIGMA);
    convolve_make_gauss(&ssim->ky, fit_radius(height), SIGMA);
    return RESULT_OK;
}

void ssim_destroy(Ssim *ssim)
{
    free(ssim->memory);
    *ssim = (Ssim){0};
}

// --- Rows of moments: [MOMENTS][width]. The last WINDOW rows, filtered along x, then two rows for
// intermediate results.

static double *row_of(const Ssim *ssim, int row)
{
    return ssim->memory + (size_t)row * MOMENTS * (size_t)ssim->width;
}

static double luma(const float *rgb)
{
    return 0.299 * (double)rgb[0] + 0.587 * (double)rgb[1] + 0.114 * (double)rgb[2];
}

static void take_moments(const Ssim *ssim, const float *a, const float *b)
{
    size_t width = (size_t)ssim->width, first = (size_t)ssim->row * width;
    double *m = row_of(ssim, WINDOW);
    for (size_t x = 0; x < width; ++x) {
        bool counts = mask_counts(ssim->mask, first + x);
        double p = counts ? luma(a + 3 * x) : 0, q = counts ? luma(b + 3 * x) : 0;
        m[x] = counts, m[width + x] = p, m[2 * width + x] = q;
        m[3 * width + x] = p * p, m[4 * width + x] = q * q, m[5 * width + x] = p * q;
    }
}

SIMD_INLINE void filter_x(const Ssim *ssim, int part)
{
    int radius = ssim->kx.radius, width = ssim->width;
    double *to = row_of(ssim, ssim->row % WINDOW);
    const double *from = row_of(ssim, WINDOW);
    (void)part;
    for (int m = 0; m < MOMENTS; ++m, to += width, from += width) {
        memset(to, 0, (size_t)width * sizeof *to);
        for (int k = 0; k <= 2 * radius; ++k) {
            double weight = ssim->kx.weights[k];
            for (int x = 0; x < width - 2 * radius; ++x) to[x] += weight * from[x + k];
        }
    }
}

// The moments of the windows whose last row is the current one.
SIMD_INLINE void filter_y(const Ssim *ssim, int part)
{
    int radius = ssim->ky.radius, count = MOMENTS * ssim->width;
    double *to = row_of(ssim, WINDOW + 1);
    (void)part;
    memset(to, 0, (size_t)count * sizeof *to);
    for (int k = 0; k <= 2 * radius; ++k) {
        double weight = ssim->ky.weights[k];
        const double *from = row_of(ssim, (ssim->row - 2 * radius + k) % WINDOW);
        for (int x = 0; x < count; ++x) to[x] += weight * from[x];
    }
}

SIMD_CALL(filter_x, Ssim)
SIMD_CALL(filter_y, Ssim)

// Equations (13) and (6) of the paper for each window.
static void add_indices(Ssim *ssim)
{
    size_t width = (size_t)ssim->width, count = width - 2 * (size_t)ssim->kx.radius;
    const double *m = row_of(ssim, WINDOW + 1);
    for (size_t x = 0; x < count; ++x) {
        double share = ssim->mask ? m[x] : 1; // exactly, without rounding errors
        if (share <= 0) continue;
        double sums[MOMENTS];
        for (size_t i = 1; i < MOMENTS; ++i) sums[i] = m[i * width + x] / share;
        double aa = sums[1] * sums[1], bb = sums[2] * sums[2], ab = sums[1] * sums[2];
        double index = (2 * ab + C1) * (2 * (sums[5] - ab) + C2) /
                       ((aa + bb + C1) * ((sums[3] - aa) + (sums[4] - bb) + C2));
        ssim->sum += share * index;
        ssim->shares += share;
    }
}

void ssim_add(Ssim *ssim, const FloatImage *a, const FloatImage *b)
{
    for (int y = 0; y < a->height; ++y, ++ssim->row) {
        size_t at = 3 * (size_t)y * (size_t)a->width;
        take_moments(ssim, a->rgb + at, b->rgb + at);
        call_filter_x(ssim);
        if (ssim->row < 2 * ssim->ky.radius) continue;
        call_filter_y(ssim);
        add_indices(ssim);
    }
}

double ssim_mean(const Ssim *ssim)
{
    return ssim->sum / ssim->shares;
}

Result ssim_compare(double *mean, const FloatImage *a, const FloatImage *b, const Mask *mask,
                    Error *error)
{
    Ssim ssim;
    TRY(ssim_create(&ssim, a->width, a->height, mask, error));
    ssim_add(&ssim, a, b);
    *mean = ssim_mean(&ssim);
    ssim_destroy(&ssim);
    return RESULT_OK;
}
