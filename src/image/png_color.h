// SPDX-License-Identifier: MIT
// The colours that a PNG file says it has. Its chunks count in this order: cICP (ITU-T H.273), iCCP
// (a profile, which is not read: taken for sRGB), sRGB, gAMA.
#pragma once

#include "base/bytes.h"
#include "base/error.h"
#include "image/image.h"

// Converts samples of another gamma, or linear ones, to sRGB; alpha stays. RESULT_BAD_INPUT with
// path and reason for colours that 8 or 16 bits of sRGB cannot hold or that need another gamut (PQ,
// HLG, BT.2020).
Result png_color_convert(Image *image, const Bytes *file, const char *path, Error *error);
