// SPDX-License-Identifier: MIT
#include "draw/tiles.h"

#include <string.h>

static int64_t divide_up(int64_t a, int64_t b)
{
    return (a + b - 1) / b;
}

// The number of parts of at most `most` pixels that an extent is cut into; at least 1.
static int parts_of(int extent, int64_t most)
{
    return (int)divide_up(extent, most < 1 ? 1 : most);
}

Tiles tiles_divide(const GpuLimits *limits, int width, int height, int samples, int64_t most)
{
    Tiles tiles = {0};
    int64_t side = limits->framebuffer_side_px / samples;
    tiles.columns = parts_of(width, side);
    tiles.width = (int)divide_up(width, tiles.columns);
    int64_t of_row = (int64_t)tiles.width * samples * samples, rows = most / of_row;
    tiles.rows = parts_of(height, rows < side ? rows : side);
    tiles.height = (int)divide_up(height, tiles.rows);
    return tiles;
}

int tiles_count(const Tiles *tiles)
{
    return tiles->columns * tiles->rows;
}

void tiles_place(const Tiles *tiles, int i, int place[2])
{
    place[0] = i % tiles->columns * tiles->width;
    place[1] = i / tiles->columns * tiles->height;
}

void tiles_copy(const Tiles *tiles, int i, const Image *tile, Image *image)
{
    int place[2];
    tiles_place(tiles, i, place);
    size_t pixel = (size_t)image->channels * image_channel_size(image->kind);
    int columns = image->width - place[0], rows = image->height - place[1];
    if (columns > tile->width) columns = tile->width;
    if (rows > tile->height) rows = tile->height;
    for (int y = 0; y < rows; ++y)
        memcpy(image->pixels +
                   ((size_t)(place[1] + y) * (size_t)image->width + (size_t)place[0]) * pixel,
               tile->pixels + (size_t)y * (size_t)tile->width * pixel, (size_t)columns * pixel);
}
