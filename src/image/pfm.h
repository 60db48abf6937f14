// SPDX-License-Identifier: MIT
// PFM files (Debevec's portable float map): three 32-bit floats a pixel, no compression.
#pragma once

#include "base/bytes.h"
#include "base/error.h"
#include "image/image.h"

// Encodes an IMAGE_FLOAT: "PF", size, "-1" for little endian, then rows from the lowest up. A
// fourth channel is left out: colours are premultiplied, and so those over black. RESULT_FAILED
// when memory is short. Free `pfm` with bytes_destroy.
Result pfm_encode(const Image *image, Bytes *pfm, Error *error);

// The reverse, from bytes in memory: an IMAGE_FLOAT of 3 channels; of "Pf" files all three are the
// grey one. Either byte order. RESULT_BAD_INPUT with `path` and reason: another kind of file, cut,
// longer than its header says, of more than 2^28 pixels, or with a number that is infinite or none.
Result pfm_decode(Image *image, const Bytes *file, const char *path, Error *error);
