// SPDX-License-Identifier: MIT
// Images of callers: RGBA, with any distance between rows.
#include "library/library.h"

#include "base/outfile.h"
#include "image/exr_file.h"
#include "image/float_image.h"
#include "image/jpeg.h"
#include "image/pfm.h"
#include "image/png.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

struct TractrixPicture {
    TractrixImage image;
};

enum { CHANNELS = 4, MOST_SIDE = 16384 };

// Rows between RGBA and RGB, with sizes that the compiler knows: every image goes through here.
// Callers' channels need not lie at multiples of their size.
#define PIXELS(type, opaque)                                                                       \
    static void put_##type(uint8_t *to, const uint8_t *from, int width)                            \
    {                                                                                              \
        const type alpha = opaque;                                                                 \
        const size_t own = 3 * sizeof(type), pixel = 4 * sizeof(type);                             \
        for (int x = 0; x < width; ++x, to += pixel, from += own) {                                \
            memcpy(to, from, own);                                                                 \
            memcpy(to + own, &alpha, sizeof alpha);                                                \
        }                                                                                          \
    }                                                                                              \
    static void take_##type(uint8_t *to, const uint8_t *from, int width)                           \
    {                                                                                              \
        const size_t own = 3 * sizeof(type), pixel = 4 * sizeof(type);                             \
        for (int x = 0; x < width; ++x, to += own, from += pixel) memcpy(to, from, own);           \
    }                                                                                              \
    static bool is_opaque_##type(const uint8_t *row, int width)                                    \
    {                                                                                              \
        const type alpha = opaque;                                                                 \
        bool all = true;                                                                           \
        for (int x = 0; x < width; ++x)                                                            \
            all &= memcmp(row + (size_t)(4 * x + 3) * sizeof alpha, &alpha, sizeof alpha) == 0;    \
        return all;                                                                                \
    }

PIXELS(uint8_t, UINT8_MAX)
PIXELS(uint16_t, UINT16_MAX)
PIXELS(float, 1)

static const struct {
    ImageKind kind;
    size_t channel; // bytes
    void (*put)(uint8_t *to, const uint8_t *from, int width);
    void (*take)(uint8_t *to, const uint8_t *from, int width);
    bool (*is_opaque)(const uint8_t *row, int width);
} FORMATS[] = {
    [TRACTRIX_RGBA8] = {IMAGE_8, 1, put_uint8_t, take_uint8_t, is_opaque_uint8_t},
    [TRACTRIX_RGBA32F] = {IMAGE_FLOAT, 4, put_float, take_float, is_opaque_float},
    [TRACTRIX_RGBA16] = {IMAGE_16, 2, put_uint16_t, take_uint16_t, is_opaque_uint16_t},
};

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
    if (to->row_bytes > (size_t)PTRDIFF_MAX / (size_t)to->height)
        return error_set(error, RESULT_USAGE,
                         "%s.row_bytes: got %zu, expected an image that fits into memory", name,
                         to->row_bytes);
    return to->pixels ? RESULT_OK : error_set(error, RESULT_USAGE, "%s.pixels: got NULL", name);
}

static uint8_t *row_of(const TractrixImage *image, int y)
{
    return (uint8_t *)image->pixels + (size_t)y * image->row_bytes;
}

void library_put_image(const TractrixImage *to, const Image *image)
{
    size_t size = image_size(image) / (size_t)image->height;
    for (int y = 0; y < to->height; ++y) {
        const uint8_t *from = image->pixels + (size_t)y * size;
        if (image->channels == CHANNELS)
            memcpy(row_of(to, y), from, size);
        else
            FORMATS[to->format].put(row_of(to, y), from, to->width);
    }
}

static bool is_opaque(const TractrixImage *image)
{
    int y = 0;
    while (y < image->height && FORMATS[image->format].is_opaque(row_of(image, y), image->width))
        ++y;
    return y == image->height;
}

// NaN equals nothing, and no file of an image may hold it.
static Result check_finite(const Image *image, const char *name, Error *error)
{
    const float *at = (const float *)(const void *)image->pixels;
    int channels = image->channels;
    size_t count = (size_t)image->width * (size_t)image->height * (size_t)channels;
    for (size_t i = 0; i < count && image->kind == IMAGE_FLOAT; ++i) {
        if (isfinite(at[i])) continue;
        size_t pixel = i / (size_t)channels, width = (size_t)image->width;
        return error_set(error, RESULT_BAD_INPUT,
                         "%s: pixel %zu, %zu: got %g in channel %d: expected finite numbers", name,
                         pixel % width, pixel / width, (double)at[i], (int)(i % (size_t)channels));
    }
    return RESULT_OK;
}

Result library_copy_image(Image *to, const TractrixImage *from, const char *name, Error *error)
{
    TRY(image_create_kind(to, from->width, from->height, is_opaque(from) ? 3 : CHANNELS,
                          FORMATS[from->format].kind, error));
    size_t size = image_size(to) / (size_t)to->height;
    for (int y = 0; y < from->height; ++y) {
        uint8_t *row = to->pixels + (size_t)y * size;
        if (to->channels == CHANNELS)
            memcpy(row, row_of(from, y), size);
        else
            FORMATS[from->format].take(row, row_of(from, y), from->width);
    }
    Result result = check_finite(to, name, error);
    if (result != RESULT_OK) image_destroy(to);
    return result;
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
    LIBRARY_CALL;
    if (!picture) return;
    free(picture->image.pixels);
    free(picture);
}

TractrixResult tractrix_picture_read(TractrixPicture **picture, const char *path,
                                     TractrixError *error)
{
    LIBRARY_CALL;
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
    LIBRARY_CALL;
    return picture ? &picture->image : NULL;
}

static bool ends_with(const char *path, const char *suffix)
{
    size_t length = strlen(path), own = strlen(suffix);
    return length > own && strcasecmp(path + length - own, suffix) == 0;
}

// Half floats reach 65,504; larger values would become infinite.
static Result check_halves(const char *path, const Image *image, Error *error)
{
    const float *at = (const float *)(const void *)image->pixels;
    size_t count = image_size(image) / sizeof *at;
    for (size_t i = 0; i < count; ++i)
        if (fabsf(at[i]) > 65504)
            return error_set(error, RESULT_USAGE, "%s: got %g: expected at most 65504 with half",
                             path, (double)at[i]);
    return RESULT_OK;
}

static Result encode(const char *path, const Image *image, bool half, Bytes *bytes, Error *error)
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
    if (half && !exr) return error_set(error, RESULT_USAGE, "%s: half floats: expected .exr", path);
    if (half) TRY(check_halves(path, image, error));
    if (jpeg) return jpeg_encode(image, JPEG_FINE, bytes, error);
    if (png) return png_encode(image, NULL, bytes, error);
    return pfm ? pfm_encode(image, bytes, error)
               : exr_file_encode(&(ExrFile){.image = image, .floats = !half}, bytes, error);
}

TractrixResult tractrix_image_write_with(const TractrixImage *image, const char *path,
                                         const TractrixWriteOptions *options, TractrixError *error)
{
    LIBRARY_CALL;
    Error why = {{0}};
    TractrixImage from;
    TractrixWriteOptions own = {0};
    Image copy = {0};
    Bytes bytes = {0};
    if (!path) return library_refuse(error, "path: got NULL");
    Result result = library_take_image(&from, image, "image", &why);
    if (options) THEN(result, library_take(&own, sizeof own, options, sizeof own, "options", &why));
    THEN(result, library_copy_image(&copy, &from, "image", &why));
    THEN(result, encode(path, &copy, own.half, &bytes, &why));
    THEN(result, bytes_write_file(&bytes, path, &why));
    bytes_destroy(&bytes);
    image_destroy(&copy);
    return library_end(result, &why, error);
}

TractrixResult tractrix_image_write(const TractrixImage *image, const char *path,
                                    TractrixError *error)
{
    LIBRARY_CALL;
    return tractrix_image_write_with(image, path, NULL, error);
}
