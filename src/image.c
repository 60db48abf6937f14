// SPDX-License-Identifier: MIT
#include "image.h"

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
