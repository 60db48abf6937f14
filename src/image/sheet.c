// SPDX-License-Identifier: MIT
#include "image/sheet.h"

#include <assert.h>
#include <stdlib.h>
#include <string.h>

static const double SIZE_MAX_BYTES = 1 << 30; // what the PNG writer takes

Result sheet_create(Sheet *sheet, int columns, int rows, const Image *tile, Error *error)
{
    *sheet = (Sheet){.columns = columns, .rows = rows};
    double size = (double)image_size(tile) * columns * rows;
    if (size >= SIZE_MAX_BYTES)
        return error_set(error, RESULT_USAGE,
                         "a sheet of %d x %d pictures of %d x %d pixels has %.3g bytes, expected "
                         "less than 1 GiB",
                         columns, rows, tile->width, tile->height, size);
    Result result = image_create_kind(&sheet->image, columns * tile->width, rows * tile->height,
                                      tile->channels, tile->kind, error);
    if (result == RESULT_OK) memset(sheet->image.pixels, 0, image_size(&sheet->image));
    return result;
}

void sheet_destroy(Sheet *sheet)
{
    image_destroy(&sheet->image);
    *sheet = (Sheet){0};
}

void sheet_add(Sheet *sheet, const Image *tile)
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
