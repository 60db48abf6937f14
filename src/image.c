// SPDX-License-Identifier: MIT
#include "image.h"

#include <math.h>
#include <stdlib.h>

Result image_create(Image *image, int width, int height, int channels, Error *error)
{
    *image = (Image){.width = width, .height = height, .channels = channels};
    image->pixels = malloc((size_t)width * (size_t)height * (size_t)channels);
    if (!image->pixels)
        return error_set(error, RESULT_FAILED, "no memory for an image of %d x %d", width, height);
    return RESULT_OK;
}

void image_destroy(Image *image)
{
    free(image->pixels);
    *image = (Image){0};
}

double image_linear_from_srgb(double value)
{
    return value <= 0.04045 ? value / 12.92 : pow((value + 0.055) / 1.055, 2.4);
}

double image_srgb_from_linear(double value)
{
    value = fmin(fmax(value, 0), 1);
    return value <= 0.0031308 ? 12.92 * value : 1.055 * pow(value, 1 / 2.4) - 0.055;
}
