// SPDX-License-Identifier: MIT
#include "image/meter.h"

#include <assert.h>
#include <math.h>
#include <stdlib.h>

static const double MOST = 20; // EV, the range of --exposure

static int compare(const void *a, const void *b)
{
    float x = *(const float *)a, y = *(const float *)b;
    return (x > y) - (x < y);
}

// The meter's input: sorted luminances of all covered pixels, and luminances of hair pixels.
typedef struct Seen {
    float *light, *hair;
    size_t count, hairs;
} Seen;

static const float *pixels_of(const Image *image)
{
    return (const float *)(const void *)image->pixels;
}

static void look(Seen *seen, const Image *image, const Image *hair)
{
    const float *pixel = pixels_of(image), *share = pixels_of(hair);
    size_t count = (size_t)image->width * (size_t)image->height;
    for (size_t i = 0; i < count; ++i, pixel += 4, share += hair->channels) {
        if (!(pixel[3] > 0.5f)) continue;
        float light = (0.2126f * pixel[0] + 0.7152f * pixel[1] + 0.0722f * pixel[2]) / pixel[3];
        seen->light[seen->count++] = light;
        if (share[0] > 0.5f) seen->hair[seen->hairs++] = light;
    }
    if (!seen->hairs)
        for (; seen->hairs < seen->count; ++seen->hairs)
            seen->hair[seen->hairs] = seen->light[seen->hairs];
    qsort(seen->light, seen->count, sizeof *seen->light, compare);
}

// The mean display value of the hair at an exposure (EV).
static double mean_shown(const Seen *seen, Tone tone, double exposure)
{
    double sum = 0, scale = exp2(exposure);
    for (size_t i = 0; i < seen->hairs; ++i)
        sum += fmin(tone_map(tone, scale * (double)seen->hair[i]), 1);
    return sum / (double)seen->hairs;
}

// The exposure in EV, before rounding. Bisection works because the mean grows with the exposure.
static double find_exposure(const Seen *seen, Tone tone)
{
    double low = -MOST, high = MOST;
    if (!seen->count || !(mean_shown(seen, tone, MOST) > METER_GREY)) return 0;
    while (high - low > METER_STEP / 16) {
        double middle = 0.5 * (low + high);
        if (mean_shown(seen, tone, middle) < METER_GREY)
            low = middle;
        else
            high = middle;
    }
    double bright = (double)seen->light[(size_t)((double)(seen->count - 1) * (1 - METER_BRIGHT))];
    return bright > 0 ? fmin(high, log2(METER_WHITE / bright)) : high;
}

Result meter_exposure(float *exposure, const Image *image, const Image *hair, Tone tone,
                      Error *error)
{
    assert(image->kind == IMAGE_FLOAT && image->channels == 4);
    assert(hair->kind == IMAGE_FLOAT);
    assert(hair->width == image->width && hair->height == image->height);
    size_t count = (size_t)image->width * (size_t)image->height;
    float *light = malloc(2 * count * sizeof *light + 1);
    if (!light) return error_set(error, RESULT_FAILED, "no memory to find the exposure");
    Seen seen = {.light = light, .hair = light + count};
    look(&seen, image, hair);
    double found = find_exposure(&seen, tone);
    free(light);
    *exposure = (float)(METER_STEP * round(found / METER_STEP));
    return RESULT_OK;
}
