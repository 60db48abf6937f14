// SPDX-License-Identifier: MIT
// JPEG files, for pictures that are looked at. They lose what a comparison would measure: at
// quality 95 a frame of curls is off by up to 18 levels, at 85 by up to 41.
#pragma once

#include "base/bytes.h"
#include "base/error.h"
#include "image/image.h"

#include <stdbool.h>

// Qualities of 1 to 100; up to 90 colours have half the resolution.
enum { JPEG_FINE = 95, JPEG_SMALL = 85 };

// Encodes an IMAGE_8 without alpha. RESULT_FAILED when memory is short, when a side has more than
// 65535 pixels, or the image is of another kind. Free `jpeg` with bytes_destroy.
Result jpeg_encode(const Image *image, int quality, Bytes *jpeg, Error *error);

// Whether the bytes begin as those of a JPEG file.
bool jpeg_is(const Bytes *file);
