// SPDX-License-Identifier: MIT
#include "report/picture.h"

#include <math.h>
#include <string.h>

// Whether no chunk changes how the colours display. Chunks: PNG specification (third edition),
// sections 5.3 and 11.3.
bool picture_is_plain(const Bytes *file)
{
    static const char *const CHANGES[] = {"gAMA", "cHRM", "iCCP", "cICP", "acTL"};
    enum { SIGNATURE_BYTES = 8, CHUNK_BYTES = 12 }; // length, name and checksum
    if (file->size < SIGNATURE_BYTES || memcmp(file->data, "\x89PNG\r\n\x1a\n", 8) != 0)
        return false;
    for (size_t at = SIGNATURE_BYTES; file->size - at >= CHUNK_BYTES;) {
        const uint8_t *head = file->data + at;
        size_t size =
            (size_t)head[0] << 24 | (size_t)head[1] << 16 | (size_t)head[2] << 8 | head[3];
        for (size_t i = 0; i < sizeof CHANGES / sizeof *CHANGES; ++i)
            if (memcmp(head + 4, CHANGES[i], 4) == 0) return false;
        if (size > file->size - at - CHUNK_BYTES) return true;
        at += size + CHUNK_BYTES;
    }
    return true;
}

static uint8_t round_level(double level)
{
    return (uint8_t)(fmin(fmax(level, 0), 255) + 0.5);
}

// Converts one pixel of an IMAGE_FLOAT.
static void convert_float(uint8_t *to, const float *from, int channels)
{
    double alpha = channels == 4 ? (double)from[3] : 1;
    for (int k = 0; k < 3; ++k)
        to[k] = round_level(
            255 * image_srgb_from_linear(alpha > 0 ? fmax((double)from[k], 0) / alpha : 0));
    if (channels == 4) to[3] = round_level(255 * alpha);
}

Result picture_create(Image *picture, const Image *image, Error *error)
{
    size_t count = (size_t)image->width * (size_t)image->height, step = (size_t)image->channels;
    TRY(image_create(picture, image->width, image->height, image->channels, error));
    const void *pixels = image->pixels;
    if (image->kind == IMAGE_8)
        memcpy(picture->pixels, image->pixels, image_size(image));
    else if (image->kind == IMAGE_16)
        for (size_t i = 0; i < count * step; ++i)
            picture->pixels[i] = round_level(((const uint16_t *)pixels)[i] / 257.0);
    else
        for (size_t i = 0; i < count; ++i)
            convert_float(picture->pixels + i * step, (const float *)pixels + i * step,
                          image->channels);
    return RESULT_OK;
}

// The mean of the picture's pixels in [begin[0], end[0]) x [begin[1], end[1]).
static void average(uint8_t *to, const Image *picture, const int begin[2], const int end[2],
                    const double linear[256])
{
    double sum[3] = {0}, weight = 0, count = 0;
    for (int y = begin[1]; y < end[1]; ++y)
        for (int x = begin[0]; x < end[0]; ++x) {
            const uint8_t *from =
                picture->pixels +
                ((size_t)y * (size_t)picture->width + (size_t)x) * (size_t)picture->channels;
            double alpha = picture->channels == 4 ? from[3] / 255.0 : 1;
            for (int k = 0; k < 3; ++k) sum[k] += alpha * linear[from[k]];
            weight += alpha;
            ++count;
        }
    for (int k = 0; k < 3; ++k)
        to[k] = round_level(255 * image_srgb_from_linear(weight > 0 ? sum[k] / weight : 0));
    if (picture->channels == 4) to[3] = round_level(255 * weight / count);
}

Result picture_create_thumbnail(Image *thumbnail, const Image *picture, int width, int height,
                                Error *error)
{
    double linear[256], across = (double)width / picture->width,
                        down = (double)height / picture->height;
    double scale = fmin(fmin(across, down), 1);
    int columns = (int)fmax(picture->width * scale, 1),
        rows = (int)fmax(picture->height * scale, 1);
    TRY(image_create(thumbnail, columns, rows, picture->channels, error));
    for (int i = 0; i < 256; ++i) linear[i] = image_linear_from_srgb(i / 255.0);
    for (int y = 0; y < rows; ++y)
        for (int x = 0; x < columns; ++x) {
            int begin[2] = {(int)((int64_t)x * picture->width / columns),
                            (int)((int64_t)y * picture->height / rows)};
            int end[2] = {(int)((int64_t)(x + 1) * picture->width / columns),
                          (int)((int64_t)(y + 1) * picture->height / rows)};
            size_t at = ((size_t)y * (size_t)columns + (size_t)x) * (size_t)picture->channels;
            average(thumbnail->pixels + at, picture, begin, end, linear);
        }
    return RESULT_OK;
}
