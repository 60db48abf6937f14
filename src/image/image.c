// SPDX-License-Identifier: MIT
#include "image/image.h"

#include <math.h>
#include <stdlib.h>

Result image_create(Image *image, int width, int height, int channels, Error *error)
{
    return image_create_kind(image, width, height, channels, IMAGE_8, error);
}

size_t image_channel_size(ImageKind kind)
{
    return kind == IMAGE_8 ? 1 : kind == IMAGE_16 ? sizeof(uint16_t) : sizeof(float);
}

size_t image_size(const Image *image)
{
    return (size_t)image->width * (size_t)image->height * (size_t)image->channels *
           image_channel_size(image->kind);
}

Result image_create_kind(Image *image, int width, int height, int channels, ImageKind kind,
                         Error *error)
{
    *image = (Image){.width = width, .height = height, .channels = channels, .kind = kind};
    image->pixels = malloc(image_size(image));
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
