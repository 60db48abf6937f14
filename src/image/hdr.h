// SPDX-License-Identifier: MIT
// Radiance images (.hdr, .pic): RGBE, in which three colours share an exponent (Ward, Graphics Gems
// II, 1991).
#pragma once

#include "base/bytes.h"
#include "base/error.h"
#include "image/image.h"

#include <stdbool.h>

// Whether the content begins as such a file: "#?RADIANCE" or "#?RGBE".
bool hdr_is(const Bytes *file);

// Decodes flat and run-length encoded files, old and new, with rows from the top (-Y N +X N), to an
// IMAGE_FLOAT of 3 channels, divided by the header's EXPOSURE. RESULT_BAD_INPUT with `path` and
// reason: another order of pixels, XYZE colours, cut off, more than 2^28 pixels or more than 64
// times as many bytes as the file has plus 64 MiB.
Result hdr_decode(Image *image, const Bytes *file, const char *path, Error *error);
