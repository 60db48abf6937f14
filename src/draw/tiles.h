// SPDX-License-Identifier: MIT
// Large images are drawn as tiles of one size, one after the other. Each tile is a window of the
// image.
#pragma once

#include "gpu/gpu.h"
#include "image/image.h"

#include <stdint.h>

// columns x rows tiles of width x height px cover the image. Tiles at the right and lower edge may
// extend beyond it.
typedef struct Tiles {
    int columns, rows;
    int width, height;
} Tiles;

// The most samples of a tile. A sample takes up to 56 bytes where there is a mesh or a floor.
// Images of up to 8192 x 8192 samples are not divided unless the driver's limits require it.
enum { TILE_MOST_SAMPLES = 1 << 26 };

// Divides an image of width x height px, with samples x samples for each, into as few tiles as
// possible. No tile is larger than the driver's limits, nor has it more than `most` samples (but at
// least one row).
Tiles tiles_divide(const GpuLimits *limits, int width, int height, int samples, int64_t most);

int tiles_count(const Tiles *tiles);

// The first pixel of tile i: x and y.
void tiles_place(const Tiles *tiles, int i, int place[2]);

// Copies the part of tile i that lies in the image into the image. Both have the same kind and
// channels.
void tiles_copy(const Tiles *tiles, int i, const Image *tile, Image *image);
