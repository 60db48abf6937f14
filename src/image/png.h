// SPDX-License-Identifier: MIT
// PNG files of 8 or 16 bits per channel, in memory and on disk. libpng reads files and writes
// chunks; png_rows.h filters and compresses.
#pragma once

#include "base/bytes.h"
#include "base/error.h"
#include "image/image.h"
#include "image/image_text.h"

// Encodes an IMAGE_8 or IMAGE_16, optimised for speed (png_rows_pack).
// The texts (NULL: none) come before the pixels, as tEXt if they are ASCII, otherwise as iTXt. The
// same image and texts give the same bytes. Thread-safe. RESULT_FAILED when memory is short or the
// image has 1 GiB or more. Free `png` with bytes_destroy.
Result png_encode(const Image *image, const ImageTexts *texts, Bytes *png, Error *error);

// Encodes an IMAGE_8 without alpha with a palette, as small as possible, for images such as heat
// maps. An image with more than 256 colours is encoded by png_encode. Errors as above.
Result png_encode_palette(const Image *image, Bytes *png, Error *error);

// Encodes without texts and writes the file, which appears complete or not at all. RESULT_FAILED
// with path and reason.
Result png_write(const char *path, const Image *image, Error *error);

// Reads a PNG file of any kind. Grey and palettes become RGB, 16 bits become the upper 8; 4
// channels with alpha, otherwise 3. Samples are converted to sRGB as the file says (png_color.h).
// RESULT_BAD_INPUT with
// path and reason if the file is missing, not a PNG file, damaged, has more than 2^28 pixels, or if
// its pixels would take more than 64 times its size plus 64 MiB.
Result png_read(Image *image, const char *path, Error *error);

// The same from memory, but 16 bits per channel stay (IMAGE_16). `path` is for messages.
Result png_decode_deep(Image *image, const Bytes *file, const char *path, Error *error);

// Reads the texts before the pixels (tEXt, zTXt, iTXt) as UTF-8; if a key occurs twice, the last
// one counts. Chunks that are damaged, too large (128 KiB) or have a key that is not ASCII are
// skipped. RESULT_BAD_INPUT if it is not a PNG file or ends before the pixels.
Result png_decode_texts(ImageTexts *texts, const Bytes *file, const char *path, Error *error);
