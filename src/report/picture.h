// SPDX-License-Identifier: MIT
// Images as browsers show them.
#pragma once

#include "base/bytes.h"
#include "base/error.h"
#include "image/image.h"

#include <stdbool.h>

// Whether browsers show the pixels of these bytes as they are: a PNG file without chunks of gamma,
// primaries, profile or animation (sRGB's own chunk is fine).
bool picture_is_plain(const Bytes *file);

// The image as IMAGE_8: 16 bits rounded; floats through sRGB's curve, their colours divided by
// alpha and clamped to 0..1. RESULT_FAILED when memory is short.
Result picture_create(Image *picture, const Image *image, Error *error);

// An IMAGE_8 made smaller, with its proportions, to fit into width x height, each pixel the mean of
// those it covers in linear light, weighted with alpha; never larger than it is. RESULT_FAILED when
// memory is short.
Result picture_create_thumbnail(Image *thumbnail, const Image *picture, int width, int height,
                                Error *error);
