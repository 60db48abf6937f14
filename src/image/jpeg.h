// SPDX-License-Identifier: MIT
// JPEG files, for viewing only. They lose what a comparison would measure: a frame of curls is off
// by up to 18 levels at quality 95, and by up to 41 at 85.
#pragma once

#include "base/bytes.h"
#include "base/error.h"
#include "image/image.h"

#include <stdbool.h>

// Qualities of 1 to 100; up to 90, colours have half the resolution.
enum { JPEG_FINE = 95, JPEG_SMALL = 85 };

// Encodes an IMAGE_8 without alpha. RESULT_FAILED when memory is short, a side exceeds 65535
// pixels, or the image is of another kind. Free `jpeg` with bytes_destroy.
Result jpeg_encode(const Image *image, int quality, Bytes *jpeg, Error *error);

// Whether the bytes begin like a JPEG file.
bool jpeg_is(const Bytes *file);
