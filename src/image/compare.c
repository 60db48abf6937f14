// SPDX-License-Identifier: MIT
#include "image/compare.h"

#include "image/flip.h"
#include "image/pixel_sums.h"
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

// The two images and the pixels to compare.
typedef struct Comparison {
    const Image *a, *b;
    const Mask *mask; // NULL: all pixels
    const CompareLimits *limits;
    unsigned figures; // to compute
} Comparison;

// A result without differences.
static CompareResult start_result(const Comparison *comparison)
{
    int width = comparison->a->width, height = comparison->a->height;
    size_t count = (size_t)width * (size_t)height;
    return (CompareResult){.width = width,
                           .height = height,
                           .compared = comparison->mask ? comparison->mask->count : count,
                           .figures = comparison->figures};
}

// An area of both images over a background. Ignored pixels are replaced by the nearest compared
// pixel, in the same way as filters extend an image beyond its border.
static Result create_areas(FloatImage areas[2], const Comparison *comparison, float background,
                           ImageArea area, Error *error)
{
    const int *nearest = comparison->mask ? comparison->mask->nearest : NULL;
    areas[0] = areas[1] = (FloatImage){0};
    TRY(float_image_create_area(&areas[0], comparison->a, nearest, background, area, error));
    return float_image_create_area(&areas[1], comparison->b, nearest, background, area, error);
}

static void destroy_areas(FloatImage areas[2])
{
    for (int i = 0; i < 2; ++i) float_image_destroy(&areas[i]);
}

static Result find_ssim(CompareResult *result, const Comparison *comparison, float background,
                        Error *error)
{
    enum { ROWS = 64 };
    Ssim ssim;
    Result outcome = ssim_create(&ssim, result->width, result->height, comparison->mask, error);
    for (int y = 0; y < result->height && outcome == RESULT_OK; y += ROWS) {
        FloatImage areas[2];
        int rows = result->height - y < ROWS ? result->height - y : ROWS;
        const ImageArea area = {0, y, result->width, rows};
        outcome = create_areas(areas, comparison, background, area, error);
        if (outcome == RESULT_OK) ssim_add(&ssim, &areas[0], &areas[1]);
        destroy_areas(areas);
    }
    if (outcome == RESULT_OK) result->ssim = ssim_mean(&ssim);
    ssim_destroy(&ssim);
    return outcome;
}

// --- FLIP, tile by tile. The pixels around a tile, as far as FLIP's filters reach, are computed in
// several tiles.

typedef struct Tiles {
    Flip flip;
    float *errors; // of a tile with the pixels around it
    int side, reach;
    float *map;   // of the whole image; NULL: none
    double total; // of the compared pixels
    double most;
} Tiles;

static Result tiles_create(Tiles *tiles, const Comparison *comparison, float *map, Error *error)
{
    int reach = flip_reach(comparison->limits->pixels_per_degree);
    int side = 4 * reach > 256 ? 4 * reach : 256;
    size_t width = (size_t)(side + 2 * reach), pixels = width * width,
           count = (size_t)comparison->a->width * (size_t)comparison->a->height;
    if (pixels > count) pixels = count;
    *tiles = (Tiles){.side = side, .reach = reach, .map = map};
    TRY(flip_create(&tiles->flip, pixels, comparison->limits->pixels_per_degree, error));
    tiles->errors = malloc(pixels * sizeof *tiles->errors);
    return tiles->errors ? RESULT_OK : error_set(error, RESULT_FAILED, "no memory for FLIP");
}

static void tiles_destroy(Tiles *tiles)
{
    flip_destroy(&tiles->flip);
    free(tiles->errors);
}

static ImageArea grow(ImageArea area, int by, const Image *image)
{
    int x = area.x > by ? area.x - by : 0, y = area.y > by ? area.y - by : 0;
    int right = area.x + area.width + by, bottom = area.y + area.height + by;
    if (right > image->width) right = image->width;
    if (bottom > image->height) bottom = image->height;
    return (ImageArea){x, y, right - x, bottom - y};
}

// Takes the errors of a tile; those of its surroundings belong to other tiles.
static void take_errors(Tiles *tiles, const Comparison *comparison, ImageArea tile,
                        ImageArea around)
{
    for (int y = tile.y; y < tile.y + tile.height; ++y)
        for (int x = tile.x; x < tile.x + tile.width; ++x) {
            float error = tiles->errors[(y - around.y) * around.width + (x - around.x)];
            size_t i = (size_t)y * (size_t)comparison->a->width + (size_t)x;
            if (!mask_counts(comparison->mask, i)) continue;
            tiles->total += (double)error;
            tiles->most = fmax(tiles->most, (double)error);
            if (tiles->map) tiles->map[i] = fmaxf(tiles->map[i], error);
        }
}

static Result add_tile(Tiles *tiles, const Comparison *comparison, float background, ImageArea tile,
                       Error *error)
{
    FloatImage areas[2];
    const ImageArea around = grow(tile, tiles->reach, comparison->a);
    size_t count = (size_t)around.width * (size_t)around.height;
    Result result = create_areas(areas, comparison, background, around, error);
    if (result == RESULT_OK &&
        memcmp(areas[0].rgb, areas[1].rgb, 3 * count * sizeof *areas[0].rgb) != 0) {
        flip_find(&tiles->flip, tiles->errors, &areas[0], &areas[1]);
        take_errors(tiles, comparison, tile, around);
    }
    destroy_areas(areas);
    return result;
}

static Result find_flip(CompareResult *result, float *map, const Comparison *comparison,
                        float background, Error *error)
{
    Tiles tiles;
    Result outcome = tiles_create(&tiles, comparison, map, error);
    for (int y = 0; y < result->height; y += tiles.side)
        for (int x = 0; x < result->width && outcome == RESULT_OK; x += tiles.side) {
            ImageArea tile = {x, y, result->width - x, result->height - y};
            if (tile.width > tiles.side) tile.width = tiles.side;
            if (tile.height > tiles.side) tile.height = tiles.side;
            outcome = add_tile(&tiles, comparison, background, tile, error);
        }
    result->flip = tiles.total / (double)result->compared;
    result->flip_most = tiles.most;
    tiles_destroy(&tiles);
    return outcome;
}

// --- Both backgrounds.

static Result compare_over(CompareResult *result, float *map, const Comparison *comparison,
                           float background, Error *error)
{
    PixelSums sums;
    *result = start_result(comparison);
    TRY(pixel_sums_find(&sums, comparison->a, comparison->b, comparison->mask, background,
                        comparison->limits->pixel_tolerance, error));
    result->failing = sums.failing;
    result->largest = sums.largest;
    memcpy(result->at, sums.at, sizeof result->at);
    result->local = sums.local;
    memcpy(result->local_at, sums.local_at, sizeof result->local_at);
    result->rmse = sqrt(sums.squares / (3 * (double)result->compared));
    result->ssim = 1;
    if (sums.largest == 0) return RESULT_OK;
    if (comparison->figures & COMPARE_SSIM) TRY(find_ssim(result, comparison, background, error));
    if (comparison->figures & COMPARE_FLIP)
        TRY(find_flip(result, map, comparison, background, error));
    return RESULT_OK;
}

static void keep_worse(CompareResult *worse, const CompareResult *other)
{
    if (other->largest > worse->largest) {
        worse->largest = other->largest;
        memcpy(worse->at, other->at, sizeof worse->at);
    }
    if (other->local > worse->local) {
        worse->local = other->local;
        memcpy(worse->local_at, other->local_at, sizeof worse->local_at);
    }
    if (other->failing > worse->failing) worse->failing = other->failing;
    worse->rmse = fmax(worse->rmse, other->rmse);
    worse->ssim = fmin(worse->ssim, other->ssim);
    worse->flip = fmax(worse->flip, other->flip);
    worse->flip_most = fmax(worse->flip_most, other->flip_most);
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
    CompareResult white;
    // Most frames of most runs are equal; this shortcut gives the same result as the computation.
    if (are_equal(a, b)) {
        result->ssim = 1;
        return RESULT_OK;
    }
    TRY(compare_over(result, map, comparison, 0, error));
    if (a->channels != 4 && b->channels != 4) return RESULT_OK;
    TRY(compare_over(&white, map, comparison, 255, error));
    keep_worse(result, &white);
    return RESULT_OK;
}

static bool is_within(const CompareResult *result, const CompareLimits *limits)
{
    double allowed =
        limits->max_failing * (limits->max_failing_percent ? 0.01 * (double)result->compared : 1);
    return (!limits->pixels_matter || (double)result->failing <= allowed) &&
           (!limits->difference_matters || result->largest <= limits->max_difference) &&
           (!limits->local_matters || result->local <= limits->max_local) &&
           (!limits->flip_matters || result->flip <= limits->max_flip);
}

Result compare_images(CompareResult *result, float *map, const Image *a, const Image *b,
                      const Mask *mask, const CompareLimits *limits, Error *error)
{
    assert(a->width == b->width && a->height == b->height);
    assert(!mask || (mask->width == a->width && mask->height == a->height));
    size_t count = (size_t)a->width * (size_t)a->height;
    if (mask && mask->count == count) mask = NULL;
    Comparison comparison = {a, b, mask, limits, limits->figures};
    if (map || limits->flip_matters) comparison.figures |= COMPARE_FLIP;
    *result = start_result(&comparison);
    for (size_t i = 0; i < count && map; ++i) map[i] = mask_counts(mask, i) ? 0 : NAN;
    TRY(compare_all(result, map, &comparison, error));
    result->equal = result->largest == 0;
    if (result->equal) result->figures = COMPARE_SSIM | COMPARE_FLIP;
    result->psnr = result->rmse > 0 ? 20 * log10(255 / result->rmse) : (double)INFINITY;
    result->within = is_within(result, limits);
    return RESULT_OK;
}

int compare_format(char *text, size_t size, const CompareResult *result)
{
    uint64_t ignored = (uint64_t)result->width * (uint64_t)result->height - result->compared;
    char note[64] = "", ssim[32] = "", flip[64] = "";
    if (ignored) snprintf(note, sizeof note, ", %llu pixels ignored", (unsigned long long)ignored);
    if (result->figures & COMPARE_SSIM) snprintf(ssim, sizeof ssim, "SSIM %.6g, ", result->ssim);
    if (result->figures & COMPARE_FLIP)
        snprintf(flip, sizeof flip, "FLIP %.4g (at most %.4g), ", result->flip, result->flip_most);
    return snprintf(text, size,
                    "RMSE %.4g, PSNR %.4g dB, %s%slargest difference %.4g at (%d, %d), local "
                    "difference %.4g at (%d, %d), %llu failing pixels (%.3g %%)%s",
                    result->rmse, result->psnr, ssim, flip, result->largest, result->at[0],
                    result->at[1], result->local, result->local_at[0], result->local_at[1],
                    (unsigned long long)result->failing,
                    100 * (double)result->failing / (double)result->compared, note);
}
