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

typedef struct Windows {
    double (*lumas)[2]; // [height][width] of a and b
    int width;
    const Mask *mask;
    ConvolveKernel kx, ky;
} Windows;

// Equations (13) and (6) of the paper for the window around x, y: weighted means, variances and
// covariance. Computed in double, because a variance is a small difference of large numbers.
// `share`: the sum of the weights of the compared pixels.
static double index_at(const Windows *windows, int x, int y, double *share)
{
    const ConvolveKernel *kx = &windows->kx, *ky = &windows->ky;
    double sums[MOMENTS] = {0}; // of a, b, aa, bb, ab
    *share = 0;
    for (int j = -ky->radius; j <= ky->radius; ++j)
        for (int i = -kx->radius; i <= kx->radius; ++i) {
            size_t pixel = (size_t)(y + j) * (size_t)windows->width + (size_t)(x + i);
            if (!mask_counts(windows->mask, pixel)) continue;
            const double *l = windows->lumas[pixel];
            double w = kx->weights[kx->radius + i] * ky->weights[ky->radius + j];
            double wa = w * l[0], wb = w * l[1];
            *share += w;
            sums[0] += wa, sums[1] += wb;
            sums[2] += wa * l[0], sums[3] += wb * l[1], sums[4] += wa * l[1];
        }
    if (!windows->mask) *share = 1; // exactly, without rounding errors
    if (*share <= 0) return 0;
    for (int i = 0; i < MOMENTS; ++i) sums[i] /= *share;
    double aa = sums[0] * sums[0], bb = sums[1] * sums[1], ab = sums[0] * sums[1];
    return (2 * ab + C1) * (2 * (sums[4] - ab) + C2) /
           ((aa + bb + C1) * ((sums[2] - aa) + (sums[3] - bb) + C2));
}

Result compare_ssim(double *ssim, const FloatImage *a, const FloatImage *b, const Mask *mask,
                    Error *error)
{
    size_t count = (size_t)a->width * (size_t)a->height;
    Windows windows = {.width = a->width, .mask = mask};
    windows.lumas = malloc(count * sizeof *windows.lumas);
    if (!windows.lumas)
        return error_set(error, RESULT_FAILED, "no memory for the SSIM of two images");
    for (size_t i = 0; i < count; ++i)
        windows.lumas[i][0] = luma(a, i), windows.lumas[i][1] = luma(b, i);
    convolve_make_gauss(&windows.kx, fit_radius(a->width), SIGMA);
    convolve_make_gauss(&windows.ky, fit_radius(a->height), SIGMA);
    int left = windows.kx.radius, top = windows.ky.radius;
    double sum = 0, shares = 0;
    for (int y = top; y < a->height - top; ++y)
        for (int x = left; x < a->width - left; ++x) {
            double share, index = index_at(&windows, x, y, &share);
            sum += share * index;
            shares += share;
        }
    *ssim = sum / shares;
    free(windows.lumas);
    return RESULT_OK;
}

// --- One background.

static void count_pixels(CompareResult *result, const CompareLimits *limits, const FloatImage *a,
                         const FloatImage *b, const Mask *mask)
{
    double sum = 0;
    size_t width = (size_t)a->width, count = width * (size_t)a->height;
    for (size_t i = 0; i < count; ++i) {
        if (!mask_counts(mask, i)) continue;
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
    result->rmse = sqrt(sum / (3 * (double)result->compared));
}

// Replaces ignored pixels by the nearest compared pixel, in the same way as filters extend an image
// beyond its border.
static void fill_ignored(FloatImage *image, const Mask *mask)
{
    size_t count = (size_t)image->width * (size_t)image->height;
    for (size_t i = 0; i < count && mask; ++i)
        memcpy(image->rgb + 3 * i, image->rgb + 3 * (size_t)mask->nearest[i],
               3 * sizeof *image->rgb);
}

// The mean and the largest FLIP value of the compared pixels.
static void take_flip(CompareResult *result, const float *map, const Mask *mask)
{
    size_t count = (size_t)result->width * (size_t)result->height;
    double sum = 0;
    for (size_t i = 0; i < count; ++i) {
        if (!mask_counts(mask, i)) continue;
        sum += (double)map[i];
        result->flip_most = fmax(result->flip_most, (double)map[i]);
    }
    result->flip = sum / (double)result->compared;
}

// The two images and the pixels to compare.
typedef struct Comparison {
    const Image *a, *b;
    const Mask *mask; // NULL: all pixels
    const CompareLimits *limits;
} Comparison;

// A result without differences.
static CompareResult start_result(const Comparison *comparison)
{
    int width = comparison->a->width, height = comparison->a->height;
    size_t count = (size_t)width * (size_t)height;
    return (CompareResult){.width = width,
                           .height = height,
                           .compared = comparison->mask ? comparison->mask->count : count};
}

static Result compare_over(CompareResult *result, float *map, const Comparison *comparison,
                           float background, Error *error)
{
    FloatImage p = {0}, q = {0};
    const Mask *mask = comparison->mask;
    const CompareLimits *limits = comparison->limits;
    double mean;
    *result = start_result(comparison);
    Result outcome = float_image_create(&p, comparison->a, background, error);
    THEN(outcome, float_image_create(&q, comparison->b, background, error));
    if (outcome == RESULT_OK) {
        fill_ignored(&p, mask);
        fill_ignored(&q, mask);
        count_pixels(result, limits, &p, &q, mask);
    }
    THEN(outcome, compare_ssim(&result->ssim, &p, &q, mask, error));
    THEN(outcome, flip_compare(map, &mean, &p, &q, limits->pixels_per_degree, error));
    if (outcome == RESULT_OK) take_flip(result, map, mask);
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

static Result add_white(CompareResult *result, float *map, const Comparison *comparison,
                        Error *error)
{
    CompareResult white;
    size_t count = (size_t)result->width * (size_t)result->height;
    float *other = malloc(count * sizeof *other);
    if (!other) return error_set(error, RESULT_FAILED, "no memory for a map of %zu pixels", count);
    Result outcome = compare_over(&white, other, comparison, 255, error);
    if (outcome == RESULT_OK) {
        keep_worse(result, &white);
        for (size_t i = 0; i < count; ++i) map[i] = fmaxf(map[i], other[i]);
    }
    free(other);
    return outcome;
}

static bool are_equal(const Image *a, const Image *b)
{
    return a->kind == b->kind && a->channels == b->channels &&
           memcmp(a->pixels, b->pixels, image_size(a)) == 0;
}

static Result compare_all(CompareResult *result, float *map, const Comparison *comparison,
                          Error *error)
{
    const Image *a = comparison->a, *b = comparison->b;
    size_t count = (size_t)a->width * (size_t)a->height;
    // Most frames of most runs are equal; this shortcut gives the same result as the computation.
    if (are_equal(a, b)) {
        result->ssim = 1;
        memset(map, 0, count * sizeof *map);
    } else {
        TRY(compare_over(result, map, comparison, 0, error));
        if (a->channels == 4 || b->channels == 4) TRY(add_white(result, map, comparison, error));
    }
    for (size_t i = 0; i < count; ++i)
        if (!mask_counts(comparison->mask, i)) map[i] = NAN;
    return RESULT_OK;
}

static bool is_within(const CompareResult *result, const CompareLimits *limits)
{
    double allowed =
        limits->max_failing * (limits->max_failing_percent ? 0.01 * (double)result->compared : 1);
    return (!limits->pixels_matter || (double)result->failing <= allowed) &&
           (!limits->flip_matters || result->flip <= limits->max_flip);
}

Result compare_images(CompareResult *result, float *map, const Image *a, const Image *b,
                      const Mask *mask, const CompareLimits *limits, Error *error)
{
    assert(a->width == b->width && a->height == b->height);
    assert(!mask || (mask->width == a->width && mask->height == a->height));
    size_t count = (size_t)a->width * (size_t)a->height;
    if (mask && mask->count == count) mask = NULL;
    const Comparison comparison = {a, b, mask, limits};
    *result = start_result(&comparison);
    float *own = map ? NULL : malloc(count * sizeof *own);
    if (!map && !own)
        return error_set(error, RESULT_FAILED, "no memory for a map of %zu pixels", count);
    Result outcome = compare_all(result, map ? map : own, &comparison, error);
    result->psnr = result->rmse > 0 ? 20 * log10(255 / result->rmse) : (double)INFINITY;
    result->same = is_within(result, limits);
    free(own);
    return outcome;
}

int compare_format(char *text, size_t size, const CompareResult *result)
{
    uint64_t ignored = (uint64_t)result->width * (uint64_t)result->height - result->compared;
    char note[64] = "";
    if (ignored) snprintf(note, sizeof note, ", %llu pixels ignored", (unsigned long long)ignored);
    return snprintf(text, size,
                    "RMSE %.4g, PSNR %.4g dB, SSIM %.6g, FLIP %.4g (at most %.4g), largest "
                    "difference %.4g at (%d, %d), %llu failing pixels (%.3g %%)%s",
                    result->rmse, result->psnr, result->ssim, result->flip, result->flip_most,
                    result->largest, result->at[0], result->at[1],
                    (unsigned long long)result->failing,
                    100 * (double)result->failing / (double)result->compared, note);
}
