// SPDX-License-Identifier: MIT
// PNG files of 8 or 16 bits a channel, to and from bytes in memory and files.
#pragma once

#include "base/bytes.h"
#include "base/error.h"
#include "image/image.h"

#include <stdbool.h>

// Encodes an IMAGE_8 or IMAGE_16. Made for speed: deflate level 1, filter 'up' in every row. The
// same image gives the same bytes. May be called from several threads at once. RESULT_FAILED when
// memory is short or the image has 1 GiB or more. Free `png` with bytes_destroy.
Result png_encode(const Image *image, Bytes *png, Error *error);

// Encodes and writes; the file appears complete or not at all. RESULT_FAILED with path and reason.
Result png_write(const char *path, const Image *image, Error *error);

// Whether `path` is a PNG file of this size and these channels (8 bits each) whose chunks are
// complete, in place and have the right checksums.
bool png_is_whole(const char *path, int width, int height, int channels);

// Reads a file of any PNG kind; grey becomes RGB, 16 bits a channel become 8; 4 channels if it has
// alpha, else 3. RESULT_BAD_INPUT with path and reason when it is missing, not a PNG, damaged, or
// of more than 2^28 pixels.
Result png_read(Image *image, const char *path, Error *error);

// The same, but 16 bits a channel stay as they are: IMAGE_16. From bytes in memory; `path` is for
// the message.
Result png_decode_deep(Image *image, const Bytes *file, const char *path, Error *error);
