// SPDX-License-Identifier: MIT
// PFM files (Debevec's portable float map): three 32-bit floats per pixel, uncompressed.
#pragma once

#include "base/bytes.h"
#include "base/error.h"
#include "image/image.h"

// Encodes an IMAGE_FLOAT: "PF", size, "-1" for little endian, then rows from the bottom up. Alpha
// is dropped; the premultiplied colours are those over black. RESULT_FAILED when memory is short.
// Free `pfm` with bytes_destroy.
Result pfm_encode(const Image *image, Bytes *pfm, Error *error);

// Decodes bytes in memory of either byte order to an IMAGE_FLOAT of 3 channels, which are equal for
// grey "Pf" files. RESULT_BAD_INPUT with `path` and reason: not a PFM file, cut off, longer than
// its header says, more than 2^28 pixels, or a number that is not finite.
Result pfm_decode(Image *image, const Bytes *file, const char *path, Error *error);
