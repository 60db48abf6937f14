// SPDX-License-Identifier: MIT
// A picture in memory: 8 bits a channel, sRGB, top row first, no padding between rows.
#pragma once

#include "error.h"

#include <stdint.h>

typedef struct Image {
    int width, height;
    int channels;    // 3: RGB, 4: RGBA with straight (not premultiplied) alpha
    uint8_t *pixels; // [height][width][channels], owned
} Image;

// Allocates; pixels are not initialised. RESULT_FAILED when memory is short.
Result image_create(Image *image, int width, int height, int channels, Error *error);
void image_destroy(Image *image);

// IEC 61966-2-1, between 0..1 and 0..1; what is linear is clamped to that first.
double image_linear_from_srgb(double value);
double image_srgb_from_linear(double value);
