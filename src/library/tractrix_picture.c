// SPDX-License-Identifier: MIT
// Images of callers: RGBA, with any distance between rows.
#include "library/library.h"

#include "base/outfile.h"
#include "image/exr_file.h"
#include "image/float_image.h"
#include "image/jpeg.h"
#include "image/pfm.h"
#include "image/png.h"

#include <stdlib.h>
#include <string.h>

struct TractrixPicture {
    TractrixImage image;
};

enum { CHANNELS = 4, MOST_SIDE = 16384 };

static const struct {
    ImageKind kind;
    size_t channel; // bytes
} FORMATS[] = {
    [TRACTRIX_RGBA8] = {IMAGE_8, 1},
    [TRACTRIX_RGBA32F] = {IMAGE_FLOAT, 4},
    [TRACTRIX_RGBA16] = {IMAGE_16, 2},
};

static const struct {
    uint8_t bytes;
    uint16_t words;
    float light;
} OPAQUE = {UINT8_MAX, UINT16_MAX, 1};

static const void *opaque_of(TractrixFormat format)
{
    return format == TRACTRIX_RGBA8    ? (const void *)&OPAQUE.bytes
           : format == TRACTRIX_RGBA16 ? (const void *)&OPAQUE.words
                                       : (const void *)&OPAQUE.light;
}

Result library_take_image(TractrixImage *to, const TractrixImage *image, const char *name,
                          Error *error)
{
    TRY(library_take(to, sizeof *to, image, sizeof *to, name, error));
    if ((unsigned)to->format >= sizeof FORMATS / sizeof *FORMATS)
        return error_set(error, RESULT_USAGE, "%s.format: got %d, expected 0 to 2", name,
                         (int)to->format);
    if (to->width < 1 || to->width > MOST_SIDE || to->height < 1 || to->height > MOST_SIDE)
        return error_set(error, RESULT_USAGE, "%s: got %dx%d, expected 1x1 to %dx%d", name,
                         to->width, to->height, MOST_SIDE, MOST_SIDE);
    size_t channel = FORMATS[to->format].channel, row = CHANNELS * channel * (size_t)to->width;
    if (!to->row_bytes) to->row_bytes = row;
    if (to->row_bytes < row || to->row_bytes % channel)
        return error_set(error, RESULT_USAGE,
                         "%s.row_bytes: got %zu, expected at least %zu, a multiple of %zu", name,
                         to->row_bytes, row, channel);
    return to->pixels ? RESULT_OK : error_set(error, RESULT_USAGE, "%s.pixels: got NULL", name);
}

void library_put_image(const TractrixImage *to, const Image *image)
{
    size_t channel = FORMATS[to->format].channel, pixel = CHANNELS * channel,
           own = (size_t)image->channels * channel;
    const uint8_t *from = image->pixels;
    for (int y = 0; y < to->height; ++y) {
        uint8_t *row = (uint8_t *)to->pixels + (size_t)y * to->row_bytes;
        for (int x = 0; x < to->width; ++x, from += own, row += pixel) {
            memcpy(row, from, own);
            if (own < pixel) memcpy(row + own, opaque_of(to->format), channel);
        }
    }
}

static bool is_opaque(const TractrixImage *image)
{
    size_t channel = FORMATS[image->format].channel, pixel = CHANNELS * channel;
    for (int y = 0; y < image->height; ++y) {
        const uint8_t *row = (const uint8_t *)image->pixels + (size_t)y * image->row_bytes;
        for (int x = 0; x < image->width; ++x)
            if (memcmp(row + (size_t)x * pixel + pixel - channel, opaque_of(image->format),
                       channel) != 0)
                return false;
    }
    return true;
}

Result library_copy_image(Image *to, const TractrixImage *from, Error *error)
{
    size_t channel = FORMATS[from->format].channel, pixel = CHANNELS * channel;
    TRY(image_create_kind(to, from->width, from->height, is_opaque(from) ? 3 : CHANNELS,
                          FORMATS[from->format].kind, error));
    size_t own = (size_t)to->channels * channel;
    uint8_t *at = to->pixels;
    for (int y = 0; y < from->height; ++y) {
        const uint8_t *row = (const uint8_t *)from->pixels + (size_t)y * from->row_bytes;
        for (int x = 0; x < from->width; ++x, at += own) memcpy(at, row + (size_t)x * pixel, own);
    }
    return RESULT_OK;
}

// --- Files.

static TractrixFormat format_of(ImageKind kind)
{
    return kind == IMAGE_8 ? TRACTRIX_RGBA8 : kind == IMAGE_16 ? TRACTRIX_RGBA16 : TRACTRIX_RGBA32F;
}

static Result make_picture(TractrixPicture **picture, const Image *image, Error *error)
{
    TractrixPicture *made = *picture = calloc(1, sizeof *made);
    TractrixFormat format = format_of(image->kind);
    size_t row = CHANNELS * FORMATS[format].channel * (size_t)image->width;
    if (made)
        made->image = (TractrixImage){.size = sizeof made->image,
                                      .width = image->width,
                                      .height = image->height,
                                      .format = format,
                                      .row_bytes = row,
                                      .pixels = malloc(row * (size_t)image->height)};
    if (!made || !made->image.pixels)
        return error_set(error, RESULT_FAILED, "no memory for a picture of %dx%d", image->width,
                         image->height);
    library_put_image(&made->image, image);
    return RESULT_OK;
}

void tractrix_picture_destroy(TractrixPicture *picture)
{
    if (!picture) return;
    free(picture->image.pixels);
    free(picture);
}

TractrixResult tractrix_picture_read(TractrixPicture **picture, const char *path,
                                     TractrixError *error)
{
    Error why = {{0}};
    Image image = {0};
    if (!picture) return library_refuse(error, "picture: got NULL");
    *picture = NULL;
    if (!path) return library_refuse(error, "path: got NULL");
    Result result = float_image_read_image(&image, path, &why);
    THEN(result, make_picture(picture, &image, &why));
    image_destroy(&image);
    if (result != RESULT_OK) {
        tractrix_picture_destroy(*picture);
        *picture = NULL;
    }
    return library_end(result, &why, error);
}

const TractrixImage *tractrix_picture_image(const TractrixPicture *picture)
{
    return &picture->image;
}

static bool ends_with(const char *path, const char *suffix)
{
    size_t length = strlen(path), own = strlen(suffix);
    return length > own && strcasecmp(path + length - own, suffix) == 0;
}

static Result encode(const char *path, const Image *image, Bytes *bytes, Error *error)
{
    bool floats = image->kind == IMAGE_FLOAT, png = ends_with(path, ".png"),
         exr = ends_with(path, ".exr"), pfm = ends_with(path, ".pfm"),
         jpeg = ends_with(path, ".jpg") || ends_with(path, ".jpeg");
    if (!png && !exr && !pfm && !jpeg)
        return error_set(error, RESULT_USAGE, "%s: expected a name with .png, .jpg, .exr or .pfm",
                         path);
    if (floats == (png || jpeg))
        return error_set(error, RESULT_USAGE, "%s: got an image of %s: expected %s", path,
                         floats ? "floats" : "whole numbers", floats ? ".exr or .pfm" : ".png");
    if (jpeg && (image->kind != IMAGE_8 || image->channels != 3))
        return error_set(error, RESULT_USAGE,
                         "%s: got an image of 16 bits or with alpha: expected .png", path);
    if (jpeg) return jpeg_encode(image, JPEG_FINE, bytes, error);
    if (png) return png_encode(image, NULL, bytes, error);
    return pfm ? pfm_encode(image, bytes, error)
               : exr_file_encode(&(ExrFile){.image = image}, bytes, error);
}

TractrixResult tractrix_image_write(const TractrixImage *image, const char *path,
                                    TractrixError *error)
{
    Error why = {{0}};
    TractrixImage from;
    Image copy = {0};
    Bytes bytes = {0};
    if (!path) return library_refuse(error, "path: got NULL");
    Result result = library_take_image(&from, image, "image", &why);
    THEN(result, library_copy_image(&copy, &from, &why));
    THEN(result, encode(path, &copy, &bytes, &why));
    THEN(result, bytes_write_file(&bytes, path, &why));
    bytes_destroy(&bytes);
    image_destroy(&copy);
    return library_end(result, &why, error);
}
