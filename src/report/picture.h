// SPDX-License-Identifier: MIT
// Images for browsers.
#pragma once

#include "base/bytes.h"
#include "base/error.h"
#include "image/image.h"

#include <stdbool.h>

// Whether browsers show the pixels unchanged: a PNG file without chunks for gamma, primaries,
// profile or animation (an sRGB chunk is fine).
bool picture_is_plain(const Bytes *file);

// Converts the image to IMAGE_8: rounds 16 bits; floats are divided by alpha, clamped to 0..1 and
// go through sRGB's curve. RESULT_FAILED when memory is short.
Result picture_create(Image *picture, const Image *image, Error *error);

// Scales an IMAGE_8 down to fit into width x height, keeping its proportions; never enlarges it.
// Each pixel is the mean of those it covers, in linear light, weighted by alpha. RESULT_FAILED when
// memory is short.
Result picture_create_thumbnail(Image *thumbnail, const Image *picture, int width, int height,
                                Error *error);
