// SPDX-License-Identifier: MIT
#include "compare.h"

#include <math.h>
#include <stdlib.h>

// Premultiplied red, green, blue, and alpha, 0 .. 255.
static void read_pixel(const Image *image, size_t i, double out[4])
{
    const uint8_t *p = &image->pixels[i * (size_t)image->channels];
    out[3] = image->channels == 4 ? p[3] : 255;
    for (int k = 0; k < 3; ++k) out[k] = p[k] * (out[3] / 255);
}

static void count_pixel(CompareResult *result, const CompareLimits *limits, const double a[4],
                        const double b[4], size_t i, int width, double *sum)
{
    double largest = 0;
    for (int k = 0; k < 4; ++k) {
        double difference = fabs(a[k] - b[k]);
        *sum += difference * difference;
        largest = fmax(largest, difference);
    }
    int level = (int)lround(largest);
    result->over += level > limits->level;
    if (level <= result->largest) return;
    result->largest = level;
    result->at[0] = (int)(i % (size_t)width), result->at[1] = (int)(i / (size_t)width);
}

Result compare_images(CompareResult *result, const Image *a, const Image *b,
                      const CompareLimits *limits, Error *error)
{
    *result = (CompareResult){0};
    if (a->width != b->width || a->height != b->height)
        return error_set(error, RESULT_FAILED, "sizes differ: %d x %d and %d x %d", a->width,
                         a->height, b->width, b->height);
    size_t count = (size_t)a->width * (size_t)a->height;
    double sum = 0;
    for (size_t i = 0; i < count; ++i) {
        double p[4], q[4];
        read_pixel(a, i, p);
        read_pixel(b, i, q);
        count_pixel(result, limits, p, q, i, a->width, &sum);
    }
    result->pixels = count;
    result->rms = sqrt(sum / (4 * (double)count));
    result->match = (double)result->over <= limits->share * (double)count;
    return RESULT_OK;
}

void compare_print(const CompareResult *result, const CompareLimits *limits, FILE *stream)
{
    fprintf(stream,
            "%s: RMS %.4g levels, largest difference %d at (%d, %d), %.4g %% of the pixels off by "
            "more than %d (allowed: %.4g %%)\n",
            result->match ? "match" : "DIFFER", result->rms, result->largest, result->at[0],
            result->at[1], 100 * (double)result->over / (double)result->pixels, limits->level,
            100 * limits->share);
}
