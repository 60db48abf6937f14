// SPDX-License-Identifier: MIT
// PNG files of 16 bits a channel, which stb_image_write does not know: signature, header, one chunk
// of pixels, end (PNG specification, sections 5 and 11).
#include "image/png.h"

#include <libdeflate.h>
#include <stdlib.h>
#include <string.h>

enum { DEFLATE_LEVEL = 1, FILTER_UP = 2 }; // as png.c

static void put32(uint8_t *to, uint32_t value)
{
    for (int k = 0; k < 4; ++k) to[k] = (uint8_t)(value >> (24 - 8 * k));
}

// Length, name and checksum around `size` bytes that stand at chunk + 8 already. Returns the end.
static uint8_t *close_chunk(uint8_t *chunk, const char name[4], size_t size)
{
    put32(chunk, (uint32_t)size);
    memcpy(chunk + 4, name, 4);
    put32(chunk + 8 + size, libdeflate_crc32(0, chunk + 4, size + 4));
    return chunk + size + 12;
}

// Each row: the filter, then big-endian samples less those above.
static void filter_rows(const Image *image, uint8_t *rows)
{
    size_t samples = (size_t)image->width * (size_t)image->channels, row = 2 * samples + 1;
    for (int y = 0; y < image->height; ++y) {
        const uint8_t *here = image->pixels + (size_t)y * 2 * samples, *above = here - 2 * samples;
        uint8_t *to = rows + (size_t)y * row;
        *to++ = FILTER_UP;
        for (size_t i = 0; i < samples; ++i) {
            uint16_t value, up = 0;
            memcpy(&value, here + 2 * i, 2);
            if (y > 0) memcpy(&up, above + 2 * i, 2);
            *to++ = (uint8_t)((value >> 8) - (up >> 8));
            *to++ = (uint8_t)(value - up);
        }
    }
}

static size_t write_file(uint8_t *file, size_t room, const Image *image,
                         struct libdeflate_compressor *compressor, const uint8_t *rows, size_t size)
{
    static const uint8_t signature[8] = {0x89, 'P', 'N', 'G', '\r', '\n', 0x1a, '\n'};
    memcpy(file, signature, sizeof signature);
    uint8_t *at = file + sizeof signature, *header = at + 8;
    put32(header, (uint32_t)image->width);
    put32(header + 4, (uint32_t)image->height);
    header[8] = 16;
    header[9] = image->channels == 4 ? 6 : 2; // RGBA, RGB
    header[10] = header[11] = header[12] = 0; // deflate, the usual filters, not interlaced
    at = close_chunk(at, "IHDR", 13);
    size_t packed = libdeflate_zlib_compress(compressor, rows, size, at + 8, room);
    at = close_chunk(at, "IDAT", packed);
    return (size_t)(close_chunk(at, "IEND", 0) - file);
}

Result png_encode16(const Image *image, Bytes *png, Error *error)
{
    size_t size = ((size_t)image->width * (size_t)image->channels * 2 + 1) * (size_t)image->height;
    *png = (Bytes){0};
    if (size >= 1 << 30)
        return error_set(error, RESULT_FAILED, "an image of %d x %d is too large for PNG here",
                         image->width, image->height);
    struct libdeflate_compressor *compressor = libdeflate_alloc_compressor(DEFLATE_LEVEL);
    size_t room = compressor ? libdeflate_zlib_compress_bound(compressor, size) : 0;
    uint8_t *rows = malloc(size), *file = malloc(room + 128);
    Result result = RESULT_OK;
    if (compressor && rows && file) {
        filter_rows(image, rows);
        *png = (Bytes){.data = file, .size = write_file(file, room, image, compressor, rows, size)};
        png->data[png->size] = 0;
    } else {
        free(file);
        result = error_set(error, RESULT_FAILED, "no memory to encode an image of %d x %d",
                           image->width, image->height);
    }
    free(rows);
    libdeflate_free_compressor(compressor);
    return result;
}
