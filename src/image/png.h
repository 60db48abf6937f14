// SPDX-License-Identifier: MIT
// PNG files of 8 or 16 bits a channel, to and from bytes in memory and files: libpng reads and
// frames chunks, libdeflate compresses.
#pragma once

#include "base/bytes.h"
#include "base/error.h"
#include "image/image.h"
#include "image/image_text.h"

// Encodes an IMAGE_8 or IMAGE_16. Made for speed: deflate level 1, filter 'up' in every row. The
// texts (NULL: none) stand before the pixels, as tEXt where they are ASCII, else as iTXt. The same
// image and texts give the same bytes. May be called from several threads at once. RESULT_FAILED
// when memory is short or the image has 1 GiB or more. Free `png` with bytes_destroy.
Result png_encode(const Image *image, const ImageTexts *texts, Bytes *png, Error *error);

// Encodes an IMAGE_8 without alpha as indices into a palette, as small as it gets, for heat maps
// and the like; one with more than 256 colours as png_encode does. Fails as that.
Result png_encode_palette(const Image *image, Bytes *png, Error *error);

// Encodes without texts and writes; the file appears complete or not at all. RESULT_FAILED with
// path and reason.
Result png_write(const char *path, const Image *image, Error *error);

// Reads a file of any PNG kind; grey and palettes become RGB, 16 bits a channel become 8 (the upper
// ones); 4 channels if it has alpha, else 3. Gamma and colour profiles are not looked at.
// RESULT_BAD_INPUT with path and reason when it is missing, not a PNG, damaged, of more than 2^28
// pixels, or when its pixels would take more than 64 times its size and 64 MiB.
Result png_read(Image *image, const char *path, Error *error);

// The same, but 16 bits a channel stay as they are: IMAGE_16. From bytes in memory; `path` is for
// the message.
Result png_decode_deep(Image *image, const Bytes *file, const char *path, Error *error);

// The texts that stand before the pixels (tEXt, zTXt, iTXt), as UTF-8; of a key that stands there
// twice the last one. Chunks that are damaged, too large (128 KiB), or whose key is not ASCII are
// left out. RESULT_BAD_INPUT if it is no PNG file or ends before the pixels.
Result png_decode_texts(ImageTexts *texts, const Bytes *file, const char *path, Error *error);
