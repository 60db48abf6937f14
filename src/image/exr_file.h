// SPDX-License-Identifier: MIT
// OpenEXR files through the C core of the OpenEXR library.
#pragma once

#include "base/bytes.h"
#include "base/error.h"
#include "image/image.h"
#include "image/image_text.h"

#include <stdbool.h>

// What is known of each pixel beside its colour, as --aov draws it: an IMAGE_FLOAT of 3 channels.
typedef enum ExrLayer {
    EXR_COVERAGE, // share of the pixel, grey
    EXR_DEPTH,    // m, grey; 0: nothing
    EXR_TANGENT,  // (1 + t) / 2; black: nothing
    EXR_STRAND,   // three bytes over 255; black: nothing
    EXR_LAYERS
} ExrLayer;

typedef struct ExrFile {
    const Image *image;      // IMAGE_FLOAT: linear, primaries of Rec. 709, premultiplied
    const Image *layers;     // [EXR_LAYERS] of the same size; NULL: none
    bool floats;             // 32 bits a channel; else 16, but for depth
    const ImageTexts *texts; // become attributes of type string; NULL: none
    // Attributes of these names, columns of a matrix for column vectors; NULL: none.
    const float (*world_to_camera)[4], (*world_to_ndc)[4];
} ExrFile;

// Channels R, G, B and A (1 where the image has no alpha); of layers coverage, Z (float),
// tangent.X, .Y and .Z (unit vectors in the world, 0: nothing), id (uint of 24 bits, 0: nothing).
// Blocks of 16 rows, ZIP. A pixel that has no strand in one of the last
// three layers has none in all. What a half cannot hold becomes infinite. The same content gives
// the same bytes. RESULT_FAILED when memory is short or the library refuses. Free `exr` with
// bytes_destroy.
Result exr_file_encode(const ExrFile *file, Bytes *exr, Error *error);

// Whether the bytes begin as an EXR file does.
bool exr_file_is(const Bytes *file);

// Reads R, G, B and A where it is there, of the first part, scanlines or tiles (their largest
// level), of any kind of number. Where these are missing: of the first layer that has them
// (diffuse.R), else Y as grey, else of a file with one channel that as grey. An IMAGE_FLOAT of the
// display window; what the data window leaves out is 0, and what lies outside is cut. From bytes in
// memory; `path` is for the message. RESULT_BAD_INPUT with path and reason: damaged, deep, of
// subsampled channels, compressed in a way that the library's core cannot undo (DWAA, DWAB), of
// more than 2^28 pixels, of pixels that would take more than 64 times its size and 64 MiB, or with
// a number that is not finite.
Result exr_file_decode(Image *image, const Bytes *file, const char *path, Error *error);

// Attributes of type string, those with a key that image_texts_set takes.
Result exr_file_decode_texts(ImageTexts *texts, const Bytes *file, const char *path, Error *error);
