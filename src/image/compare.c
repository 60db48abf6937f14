// SPDX-License-Identifier: MIT
#include "image/compare.h"

#include "image/convolve.h"
#include "image/flip.h"

#include <assert.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

CompareLimits compare_limits_default(void)
{
    return (CompareLimits){.pixels_matter = true, .pixels_per_degree = FLIP_PIXELS_PER_DEGREE};
}

// --- Structural similarity.

enum { WINDOW = 11, MOMENTS = 5 };

static const double SIGMA = 1.5, C1 = (0.01 * 255) * (0.01 * 255), C2 = (0.03 * 255) * (0.03 * 255);

static double luma(const FloatImage *image, size_t i)
{
    const float *rgb = image->rgb + 3 * i;
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

Result compare_ssim(double *ssim, const FloatImage *a, const FloatImage *b, Error *error)
{
    ConvolveKernel kx, ky;
    size_t count = (size_t)a->width * (size_t)a->height;
    double(*lumas)[2] = malloc(count * sizeof *lumas), sum = 0;
    if (!lumas) return error_set(error, RESULT_FAILED, "no memory for the SSIM of two images");
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

// --- One background.

static void count_pixels(CompareResult *result, const CompareLimits *limits, const FloatImage *a,
                         const FloatImage *b)
{
    double sum = 0;
    size_t width = (size_t)a->width, count = width * (size_t)a->height;
    for (size_t i = 0; i < count; ++i) {
        double largest = 0;
        for (size_t k = 3 * i; k < 3 * i + 3; ++k) {
            double difference = fabs((double)a->rgb[k] - (double)b->rgb[k]);
            sum += difference * difference;
            largest = fmax(largest, difference);
        }
        result->failing += largest > limits->pixel_tolerance;
        if (largest <= result->largest) continue;
        result->largest = largest;
        result->at[0] = (int)(i % width), result->at[1] = (int)(i / width);
    }
    result->rmse = sqrt(sum / (3 * (double)count));
}

static Result compare_over(CompareResult *result, float *map, const Image *a, const Image *b,
                           float background, const CompareLimits *limits, Error *error)
{
    FloatImage p = {0}, q = {0};
    *result = (CompareResult){.width = a->width, .height = a->height};
    Result outcome = float_image_create(&p, a, background, error);
    THEN(outcome, float_image_create(&q, b, background, error));
    if (outcome == RESULT_OK) count_pixels(result, limits, &p, &q);
    THEN(outcome, compare_ssim(&result->ssim, &p, &q, error));
    THEN(outcome, flip_compare(map, &result->flip, &p, &q, limits->pixels_per_degree, error));
    size_t count = (size_t)a->width * (size_t)a->height;
    for (size_t i = 0; i < count && outcome == RESULT_OK; ++i)
        result->flip_most = fmax(result->flip_most, (double)map[i]);
    float_image_destroy(&p);
    float_image_destroy(&q);
    return outcome;
}

// --- Both backgrounds.

static void keep_worse(CompareResult *worse, const CompareResult *other)
{
    if (other->largest > worse->largest) {
        worse->largest = other->largest;
        memcpy(worse->at, other->at, sizeof worse->at);
    }
    if (other->failing > worse->failing) worse->failing = other->failing;
    worse->rmse = fmax(worse->rmse, other->rmse);
    worse->ssim = fmin(worse->ssim, other->ssim);
    worse->flip = fmax(worse->flip, other->flip);
    worse->flip_most = fmax(worse->flip_most, other->flip_most);
}

static Result add_white(CompareResult *result, float *map, const Image *a, const Image *b,
                        const CompareLimits *limits, Error *error)
{
    CompareResult white;
    size_t count = (size_t)a->width * (size_t)a->height;
    float *other = malloc(count * sizeof *other);
    if (!other) return error_set(error, RESULT_FAILED, "no memory for a map of %zu pixels", count);
    Result outcome = compare_over(&white, other, a, b, 255, limits, error);
    if (outcome == RESULT_OK) {
        keep_worse(result, &white);
        for (size_t i = 0; i < count; ++i) map[i] = fmaxf(map[i], other[i]);
    }
    free(other);
    return outcome;
}

Result compare_images(CompareResult *result, float *map, const Image *a, const Image *b,
                      const CompareLimits *limits, Error *error)
{
    assert(a->width == b->width && a->height == b->height);
    size_t count = (size_t)a->width * (size_t)a->height;
    double allowed =
        limits->max_failing * (limits->max_failing_percent ? 0.01 * a->width * a->height : 1);
    if (a->kind == b->kind && a->channels == b->channels &&
        memcmp(a->pixels, b->pixels, image_size(a)) == 0) {
        // Most frames of most runs: the long way would give just this.
        *result = (CompareResult){.width = a->width, .height = a->height};
        result->psnr = INFINITY, result->ssim = 1, result->same = true;
        if (map) memset(map, 0, count * sizeof *map);
        return RESULT_OK;
    }
    float *own = map ? NULL : malloc(count * sizeof *own);
    if (!map && !own)
        return error_set(error, RESULT_FAILED, "no memory for a map of %zu pixels", count);
    if (!map) map = own;
    Result outcome = compare_over(result, map, a, b, 0, limits, error);
    if (outcome == RESULT_OK && (a->channels == 4 || b->channels == 4))
        outcome = add_white(result, map, a, b, limits, error);
    result->psnr = result->rmse > 0 ? 20 * log10(255 / result->rmse) : (double)INFINITY;
    result->same = (!limits->pixels_matter || (double)result->failing <= allowed) &&
                   (!limits->flip_matters || result->flip <= limits->max_flip);
    free(own);
    return outcome;
}

int compare_format(char *text, size_t size, const CompareResult *result)
{
    double pixels = (double)result->width * result->height;
    return snprintf(text, size,
                    "RMSE %.4g, PSNR %.4g dB, SSIM %.6g, FLIP %.4g (at most %.4g), largest "
                    "difference %.4g at (%d, %d), %llu failing pixels (%.3g %%)",
                    result->rmse, result->psnr, result->ssim, result->flip, result->flip_most,
                    result->largest, result->at[0], result->at[1],
                    (unsigned long long)result->failing, 100 * (double)result->failing / pixels);
}
