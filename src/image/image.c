// SPDX-License-Identifier: MIT
#include "image/image.h"

#include "glsl/common/shared_math.h"

#include <assert.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

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

bool image_is_equal(const Image *a, const Image *b)
{
    return a->pixels && b->pixels && a->width == b->width && a->height == b->height &&
           a->channels == b->channels && a->kind == b->kind &&
           memcmp(a->pixels, b->pixels, image_size(a)) == 0;
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
    return srgb_decode(value);
}

double image_srgb_from_linear(double value)
{
    return srgb_encode(fmin(fmax(value, 0), 1));
}

// --- Contact sheets.

static const double SHEET_MAX_BYTES = 1 << 30; // limit of the PNG writer

Result image_sheet_create(ImageSheet *sheet, int columns, int rows, const Image *tile, Error *error)
{
    *sheet = (ImageSheet){.columns = columns, .rows = rows};
    double size = (double)image_size(tile) * columns * rows;
    if (size >= SHEET_MAX_BYTES)
        return error_set(error, RESULT_USAGE,
                         "a sheet of %d x %d tiles of %d x %d pixels has %.3g bytes, expected "
                         "less than 1 GiB",
                         columns, rows, tile->width, tile->height, size);
    TRY(image_create_kind(&sheet->image, columns * tile->width, rows * tile->height, tile->channels,
                          tile->kind, error));
    memset(sheet->image.pixels, 0, image_size(&sheet->image));
    return RESULT_OK;
}

void image_sheet_destroy(ImageSheet *sheet)
{
    image_destroy(&sheet->image);
    *sheet = (ImageSheet){0};
}

void image_sheet_add(ImageSheet *sheet, const Image *tile)
{
    assert(sheet->count < sheet->columns * sheet->rows);
    size_t line = image_size(tile) / (size_t)tile->height;
    size_t row = (size_t)(sheet->count / sheet->columns) * (size_t)tile->height;
    size_t column = (size_t)(sheet->count % sheet->columns);
    for (size_t y = 0; y < (size_t)tile->height; ++y)
        memcpy(sheet->image.pixels + ((row + y) * (size_t)sheet->columns + column) * line,
               tile->pixels + y * line, line);
    ++sheet->count;
}
