// SPDX-License-Identifier: MIT
#include "image/mask.h"

#include "image/float_image.h"

#include <stdint.h>
#include <stdlib.h>

// --- The nearest compared pixel, searched along columns and then across them.

// For each pixel, the row of the nearest compared pixel in its column; -1 if there is none, the
// upper one if two are equally near.
static void find_rows(int *rows, const bool *compared, int width, int height)
{
    for (int x = 0; x < width; ++x) {
        int above = -1;
        for (int y = 0; y < height; ++y) {
            size_t i = (size_t)y * (size_t)width + (size_t)x;
            if (compared[i]) above = y;
            rows[i] = above;
        }
        int below = -1;
        for (int y = height - 1; y >= 0; --y) {
            size_t i = (size_t)y * (size_t)width + (size_t)x;
            if (compared[i]) below = y;
            if (below >= 0 && (rows[i] < 0 || below - y < y - rows[i])) rows[i] = below;
        }
    }
}

// Searches columns on both sides of x until they are farther away than the best pixel so far. Of
// equally near pixels, the first one found wins.
static int find_nearest(const int *rows, int width, int x, int y)
{
    int64_t best = INT64_MAX;
    int nearest = 0;
    for (int64_t off = 0; off < width && off * off < best; ++off)
        for (int side = -1; side <= 1; side += 2) {
            int64_t column = x + side * off;
            if (column < 0 || column >= width || rows[column] < 0) continue;
            int64_t down = rows[column] - y, distance = off * off + down * down;
            if (distance >= best) continue;
            best = distance;
            nearest = (int)(rows[column] * (int64_t)width + column);
        }
    return nearest;
}

Result mask_create(Mask *mask, const bool *compared, int width, int height, Error *error)
{
    size_t count = (size_t)width * (size_t)height;
    int *rows = malloc(count * sizeof *rows);
    *mask = (Mask){.width = width, .height = height, .nearest = malloc(count * sizeof(int))};
    for (size_t i = 0; i < count; ++i) mask->count += compared[i];
    Result result = RESULT_OK;
    if (!rows || !mask->nearest)
        result = error_set(error, RESULT_FAILED, "no memory for a mask of %d x %d", width, height);
    else if (mask->count == 0)
        result = error_set(error, RESULT_BAD_INPUT,
                           "the whole mask is black: expected white where images are compared");
    if (result == RESULT_OK) {
        find_rows(rows, compared, width, height);
        for (int y = 0; y < height; ++y)
            for (int x = 0; x < width; ++x)
                mask->nearest[(size_t)y * (size_t)width + (size_t)x] =
                    find_nearest(rows + (size_t)y * (size_t)width, width, x, y);
    } else {
        mask_destroy(mask);
    }
    free(rows);
    return result;
}

void mask_destroy(Mask *mask)
{
    free(mask->nearest);
    *mask = (Mask){0};
}

// --- Files.

static Result read_compared(bool **compared, const Image *image, Error *error)
{
    FloatImage floats;
    TRY(float_image_create(&floats, image, 255, error));
    size_t count = (size_t)floats.width * (size_t)floats.height;
    *compared = malloc(count * sizeof **compared);
    for (size_t i = 0; i < count && *compared; ++i) {
        const float *rgb = floats.rgb + 3 * i;
        (*compared)[i] = 0.299F * rgb[0] + 0.587F * rgb[1] + 0.114F * rgb[2] >= 127.5F;
    }
    float_image_destroy(&floats);
    return *compared ? RESULT_OK : error_set(error, RESULT_FAILED, "no memory for a mask");
}

Result mask_create_from(Mask *mask, const Image *image, Error *error)
{
    bool *compared = NULL;
    *mask = (Mask){0};
    Result result = read_compared(&compared, image, error);
    THEN(result, mask_create(mask, compared, image->width, image->height, error));
    free(compared);
    return result;
}

Result mask_read(Mask *mask, const char *path, Error *error)
{
    Image image;
    *mask = (Mask){0};
    TRY(float_image_read_image(&image, path, error));
    Result result = mask_create_from(mask, &image, error);
    if (result != RESULT_OK) error_prefix(error, result, "%s: ", path);
    image_destroy(&image);
    return result;
}
