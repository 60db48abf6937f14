// SPDX-License-Identifier: MIT
#include "image/pfm.h"

#include <assert.h>
#include <endian.h>
#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

Result pfm_encode(const Image *image, Bytes *pfm, Error *error)
{
    assert(image->kind == IMAGE_FLOAT);
    char header[64];
    size_t head = (size_t)snprintf(header, sizeof header, "PF\n%d %d\n-1.0\n", image->width,
                                   image->height),
           width = (size_t)image->width, row = 12 * width,
           pitch = width * (size_t)image->channels * 4;
    *pfm = (Bytes){.size = head + row * (size_t)image->height};
    pfm->data = malloc(pfm->size + 1);
    if (!pfm->data) {
        *pfm = (Bytes){0};
        return error_set(error, RESULT_FAILED, "no memory to encode an image of %d x %d",
                         image->width, image->height);
    }
    memcpy(pfm->data, header, head);
    for (int y = 0; y < image->height; ++y) {
        const uint8_t *from = image->pixels + (size_t)(image->height - 1 - y) * pitch;
        uint8_t *to = pfm->data + head + (size_t)y * row;
        for (size_t i = 0; i < 3 * width; ++i) {
            uint32_t bits;
            memcpy(&bits, from + 4 * (i / 3 * (size_t)image->channels + i % 3), sizeof bits);
            bits = htole32(bits);
            memcpy(to + 4 * i, &bits, sizeof bits);
        }
    }
    pfm->data[pfm->size] = 0;
    return RESULT_OK;
}

// --- Reading.

typedef struct Header {
    int width, height, channels;
    bool big_endian;
    size_t size; // bytes of the header
} Header;

static bool read_header(Header *header, const Bytes *file)
{
    char kind = 0;
    double scale = 0;
    int end = 0;
    // The data ends with a zero byte, and %9d limits the numbers to what an int holds.
    if (sscanf((const char *)file->data, "P%c%*1[\n]%9d %9d%*1[\n]%lf%n", &kind, &header->width,
               &header->height, &scale, &end) != 4 ||
        (kind != 'F' && kind != 'f') || file->data[end] != '\n')
        return false;
    header->channels = kind == 'F' ? 3 : 1;
    header->big_endian = scale > 0;
    header->size = (size_t)end + 1;
    return header->width > 0 && header->height > 0 && isfinite(scale) && scale != 0;
}

// Copies the pixels of a file whose size was checked. False if a value is not finite.
static bool take_pixels(Image *image, const Header *header, const uint8_t *from)
{
    size_t width = (size_t)header->width, channels = (size_t)header->channels;
    float *pixels = (float *)(void *)image->pixels;
    bool finite = true;
    for (size_t y = 0; y < (size_t)header->height; ++y) {
        float *to = pixels + ((size_t)header->height - 1 - y) * width * 3;
        for (size_t i = 0; i < width * 3; ++i) {
            uint32_t bits;
            size_t at = channels == 3 ? i : i / 3;
            memcpy(&bits, from + 4 * (y * width * channels + at), sizeof bits);
            bits = header->big_endian ? be32toh(bits) : le32toh(bits);
            memcpy(&to[i], &bits, sizeof bits);
            finite = finite && isfinite(to[i]);
        }
    }
    return finite;
}

Result pfm_decode(Image *image, const Bytes *file, const char *path, Error *error)
{
    Header header;
    *image = (Image){0};
    if (!read_header(&header, file))
        return error_set(error, RESULT_BAD_INPUT, "%s: not a readable PFM file", path);
    long long count = (long long)header.width * header.height;
    if (count > 1 << 28)
        return error_set(error, RESULT_BAD_INPUT, "%s: %d x %d pixels: expected at most %d pixels",
                         path, header.width, header.height, 1 << 28);
    size_t size = (size_t)count * (size_t)header.channels * 4;
    if (file->size - header.size != size)
        return error_set(error, RESULT_BAD_INPUT, "%s: %zu bytes of pixels, expected %zu", path,
                         file->size - header.size, size);
    Result result = image_create_kind(image, header.width, header.height, 3, IMAGE_FLOAT, error);
    if (result != RESULT_OK || take_pixels(image, &header, file->data + header.size)) return result;
    image_destroy(image);
    return error_set(error, RESULT_BAD_INPUT,
                     "%s: has infinite numbers or NaN: expected finite numbers", path);
}
