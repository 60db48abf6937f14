// SPDX-License-Identifier: MIT
// An image that is too large to be drawn at once is drawn as tiles of one size, each a window onto
// it, one after the other.
#pragma once

#include "gpu/gpu.h"
#include "image/image.h"

#include <stdint.h>

// columns x rows tiles of width x height px cover the image; those at its right and lower edge may
// hang over.
typedef struct Tiles {
    int columns, rows;
    int width, height;
} Tiles;

// The samples that a tile has at most, of up to 56 bytes where there is a mesh or a floor. No image
// of up to 8192 x 8192 samples is divided but where the driver wants it.
enum { TILE_MOST_SAMPLES = 1 << 26 };

// Few tiles of an image of width x height px of samples x samples, none larger than the driver
// draws, nor of more samples than `most` (or one row of them).
Tiles tiles_divide(const GpuLimits *limits, int width, int height, int samples, int64_t most);

int tiles_count(const Tiles *tiles);

// The first px of tile i, x and y.
void tiles_place(const Tiles *tiles, int i, int place[2]);

// Copies what of tile i lies in the image into it; both have the same kind and channels.
void tiles_copy(const Tiles *tiles, int i, const Image *tile, Image *image);
