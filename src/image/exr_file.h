// SPDX-License-Identifier: MIT
// OpenEXR files through the C core of the OpenEXR library.
#pragma once

#include "base/bytes.h"
#include "base/error.h"
#include "image/image.h"
#include "image/image_text.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

// Data of each pixel besides its colour, as drawn by --aov: an IMAGE_FLOAT of 3 channels.
typedef enum ExrLayer {
    EXR_COVERAGE, // share of the pixel, grey
    EXR_DEPTH,    // m, grey; 0 if empty
    EXR_TANGENT,  // (1 + t) / 2; black if empty
    EXR_STRAND,   // three bytes, divided by 255; black if empty
    EXR_LAYERS
} ExrLayer;

// The data of a pixel, as files hold it.
typedef struct ExrPixel {
    float coverage, depth; // m; 0: empty
    float tangent[3];      // a unit vector; 0: empty
    uint32_t strand;       // 24 bits; 0: empty
} ExrPixel;

// Pixel i of the layers. A layer shows the nearest strand that covers enough of the pixel. Layers
// are rendered one by one, so if a strand covers just about enough, some layers may show it and
// others may not: then all but the coverage are empty.
ExrPixel exr_file_pixel(const float *const layers[EXR_LAYERS], size_t i);

typedef struct ExrFile {
    const Image *image;      // IMAGE_FLOAT: linear, primaries of Rec. 709, premultiplied
    const Image *layers;     // [EXR_LAYERS] of the same size; NULL if there are none
    bool alpha;              // write A, which is 1, also if the image has no alpha
    bool floats;             // 32 bits per channel, otherwise 16 (depth always has 32)
    const ImageTexts *texts; // written as attributes of type string; NULL if there are none
    // Attributes of these names, columns of a matrix for column vectors; NULL if there are none.
    const float (*world_to_camera)[4], (*world_to_ndc)[4];
} ExrFile;

// Writes the channels R, G, B, A if the image has alpha or `alpha` is set, and those of the layers:
// coverage, Z (float), tangent.X, .Y and .Z (unit vectors in the world, 0 if empty), id (24 bits in
// a uint, 0 if empty). Blocks of 16 rows, ZIP. If one of the last three layers is empty at a pixel,
// all three are. Values beyond the range of half become infinite. The same content gives the same
// bytes. RESULT_FAILED when memory is short or the library fails. Free `exr` with bytes_destroy.
Result exr_file_encode(const ExrFile *file, Bytes *exr, Error *error);

// Whether the bytes begin like an EXR file.
bool exr_file_is(const Bytes *file);

// Reads R, G, B and, if present, A of the first part, from scanlines or tiles (largest level), of
// any number type. If they are missing, uses the first layer that has them (diffuse.R), otherwise Y
// as grey, otherwise the only channel of the file as grey. The result is an IMAGE_FLOAT of the
// display window; it is 0 outside of the data window, and data outside the display window is
// dropped. `path` is for messages. RESULT_BAD_INPUT with path and reason: damaged, deep, subsampled
// channels, a compression that the library's core does not support (DWAA, DWAB), more than 2^28
// pixels, pixels that would take more than 64 times the file's size plus 64 MiB, or a number that
// is not finite.
Result exr_file_decode(Image *image, const Bytes *file, const char *path, Error *error);

// Reads the attributes of type string whose key image_texts_set accepts.
Result exr_file_decode_texts(ImageTexts *texts, const Bytes *file, const char *path, Error *error);
