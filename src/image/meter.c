// SPDX-License-Identifier: MIT
#include "image/meter.h"

#include <assert.h>
#include <math.h>
#include <stdlib.h>

static int compare(const void *a, const void *b)
{
    float x = *(const float *)a, y = *(const float *)b;
    return (x > y) - (x < y);
}

// Luminances of the pixels that count, sorted. Returns how many.
static size_t list_luminances(const Image *image, float *light)
{
    const float *pixel = (const float *)(const void *)image->pixels;
    size_t count = (size_t)image->width * (size_t)image->height, listed = 0;
    for (size_t i = 0; i < count; ++i, pixel += 4)
        if (pixel[3] > 0.5f)
            light[listed++] =
                (0.2126f * pixel[0] + 0.7152f * pixel[1] + 0.0722f * pixel[2]) / pixel[3];
    qsort(light, listed, sizeof *light, compare);
    return listed;
}

// EV before rounding.
static double find_exposure(const float *light, size_t count)
{
    double bright = (double)light[(size_t)((double)(count - 1) * (1 - METER_BRIGHT))], sum = 0;
    if (!(bright > 0)) return 0;
    // What is black counts as a thousandth of what is bright.
    for (size_t i = 0; i < count; ++i) sum += log2(fmax((double)light[i], 1e-3 * bright));
    double off = log2(METER_MIDDLE) - sum / (double)count;
    return fmin((1 - METER_KEPT) * off, log2(METER_WHITE / bright));
}

Result meter_exposure(float *exposure, const Image *image, Error *error)
{
    assert(image->kind == IMAGE_FLOAT && image->channels == 4);
    float *light = malloc((size_t)image->width * (size_t)image->height * sizeof *light);
    if (!light) return error_set(error, RESULT_FAILED, "no memory to find the exposure");
    size_t count = list_luminances(image, light);
    double found = count ? find_exposure(light, count) : 0;
    free(light);
    *exposure = (float)(METER_STEP * round(found / METER_STEP));
    return RESULT_OK;
}
