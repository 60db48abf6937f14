// SPDX-License-Identifier: MIT
#include "image/compare.h"

#include "image/flip.h"
#include "image/float_image.h"
#include "image/ssim.h"

#include <assert.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

CompareLimits compare_limits_default(void)
{
    return (CompareLimits){.pixels_matter = true, .pixels_per_degree = FLIP_PIXELS_PER_DEGREE};
}

double compare_allowance(const CompareLimits *limits, int width, int height)
{
    double factor = limits->max_failing_percent ? 0.01 * width * height : 1;
    return limits->max_failing * factor;
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

static Result compare_plates(CompareResult *result, float *map, const FloatImage *a,
                             const FloatImage *b, const CompareLimits *limits, Error *error)
{
    count_pixels(result, limits, a, b);
    Result outcome = ssim_compare(&result->ssim, a, b, error);
    if (outcome == RESULT_OK)
        outcome = flip_compare(map, &result->flip, a, b, limits->pixels_per_degree, error);
    size_t count = (size_t)a->width * (size_t)a->height;
    for (size_t i = 0; i < count && outcome == RESULT_OK; ++i)
        result->flip_most = fmax(result->flip_most, (double)map[i]);
    return outcome;
}

static Result compare_over(CompareResult *result, float *map, const Image *a, const Image *b,
                           float background, const CompareLimits *limits, Error *error)
{
    FloatImage p = {0}, q = {0};
    *result = (CompareResult){.width = a->width, .height = a->height};
    Result outcome = float_image_create(&p, a, background, error);
    if (outcome == RESULT_OK) outcome = float_image_create(&q, b, background, error);
    if (outcome == RESULT_OK) outcome = compare_plates(result, map, &p, &q, limits, error);
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

static bool within(const CompareResult *result, const CompareLimits *limits)
{
    double allowed = compare_allowance(limits, result->width, result->height);
    return (!limits->pixels_matter || (double)result->failing <= allowed) &&
           (!limits->flip_matters || result->flip <= limits->max_flip);
}

static bool is_equal(const Image *a, const Image *b)
{
    return a->kind == b->kind && a->channels == b->channels &&
           memcmp(a->pixels, b->pixels, image_size(a)) == 0;
}

Result compare_images(CompareResult *result, float *map, const Image *a, const Image *b,
                      const CompareLimits *limits, Error *error)
{
    assert(a->width == b->width && a->height == b->height);
    size_t count = (size_t)a->width * (size_t)a->height;
    if (is_equal(a, b)) { // most frames of most runs: what follows would find just this
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
    result->same = within(result, limits);
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
