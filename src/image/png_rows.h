// SPDX-License-Identifier: MIT
// The pixel rows of a PNG file, filtered and compressed: the data of its IDAT chunk.
#pragma once

#include "base/bytes.h"
#include "image/image.h"

#include <stdbool.h>

// Packs the rows for speed: filter 'up' in every row, compressed by ISA-L. The same image gives the
// same bytes on the same kind of processor. Free `packed` with bytes_destroy. False when memory is
// short or ISA-L refuses; `packed` is then empty.
bool png_rows_pack(const Image *image, Bytes *packed);

// Packs an IMAGE_8 with 1 channel, whose values are indices of a palette, as small as possible. The
// rows are unfiltered, because no filter makes such files smaller. Otherwise like png_rows_pack.
bool png_rows_pack_indices(const Image *image, Bytes *packed);
