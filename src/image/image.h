// SPDX-License-Identifier: MIT
// The room image: images on the CPU. Input: pixels or files (PNG, PFM, EXR). Output: files, contact
// sheets, and measures of the difference of two images (compare.h, flip.h).
//
// This file: an image in memory, top row first, without padding between rows.
#pragma once

#include "base/error.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

// 8 and 16 bits: sRGB, straight (not premultiplied) alpha. Float: linear light, premultiplied.
typedef enum ImageKind { IMAGE_8, IMAGE_16, IMAGE_FLOAT } ImageKind;

typedef struct Image {
    int width, height;
    int channels;    // 3: RGB, 4: RGBA
    uint8_t *pixels; // [height][width][channels] of uint8_t, uint16_t or float, owned
    ImageKind kind;
} Image;

// Allocates; pixels are not initialised. RESULT_FAILED when memory is short.
Result image_create(Image *image, int width, int height, int channels, Error *error); // IMAGE_8
Result image_create_kind(Image *image, int width, int height, int channels, ImageKind kind,
                         Error *error);
void image_destroy(Image *image);

// Bytes of one channel, and of all pixels.
size_t image_channel_size(ImageKind kind);
size_t image_size(const Image *image);

// Whether both images have pixels, and these are equal.
bool image_is_equal(const Image *a, const Image *b);

// IEC 61966-2-1, between 0..1 and 0..1; linear values are clamped first.
double image_linear_from_srgb(double value);
double image_srgb_from_linear(double value);

// A contact sheet: images of one size side by side, row by row, without gaps.
typedef struct ImageSheet {
    Image image;
    int columns, rows;
    int count; // tiles filled so far
} ImageSheet;

// Allocates columns x rows tiles of this size and kind; tiles that are never filled are black or
// transparent. RESULT_USAGE if the sheet has 1 GiB or more, RESULT_FAILED when memory is short. A
// zeroed struct may be destroyed.
Result image_sheet_create(ImageSheet *sheet, int columns, int rows, const Image *tile,
                          Error *error);
void image_sheet_destroy(ImageSheet *sheet);

// Fills the next tile, from left to right and top to bottom. One must be left.
void image_sheet_add(ImageSheet *sheet, const Image *tile);
