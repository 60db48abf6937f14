// SPDX-License-Identifier: MIT
// Chunks, kinds of pixels and filters as in the PNG specification, sections 5, 9 and 11.
#include "image/png.h"

#include <endian.h>
#include <libdeflate.h>
#include <limits.h>
#include <stdlib.h>
#include <string.h>

#define STB_IMAGE_IMPLEMENTATION
#define STBI_ONLY_PNG
#define STBI_NO_STDIO
#define STBI_MAX_DIMENSIONS (1 << 20)
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wunused-parameter"
#pragma GCC diagnostic ignored "-Wunused-but-set-variable"
#pragma GCC diagnostic ignored "-Wshadow"
#pragma GCC diagnostic ignored "-Wmissing-field-initializers"
#pragma GCC diagnostic ignored "-Wsign-compare"
#include <stb_image.h>
#pragma GCC diagnostic pop

// Measured on frames of hair: the higher levels take half as long again for little or no gain in
// size, and as hair runs downwards the row above predicts well.
enum { DEFLATE_LEVEL = 1, FILTER_UP = 2 };
enum { ENCODE_MAX_BYTES = 1 << 30, READ_MAX_PIXELS = 1 << 28 };
enum { CHUNK_HEAD_BYTES = 8, CHUNK_EXTRA_BYTES = 12, IHDR_BYTES = 13, END_BYTES = 64 };

static const uint8_t SIGNATURE[8] = {0x89, 'P', 'N', 'G', '\r', '\n', 0x1a, '\n'};

static uint8_t color_type(int channels)
{
    return channels == 4 ? 6 : 2;
}

static void put_u32(uint8_t *to, uint32_t value)
{
    for (int k = 0; k < 4; ++k) to[k] = (uint8_t)(value >> (24 - 8 * k));
}

static uint32_t take_u32(const uint8_t *bytes)
{
    return (uint32_t)bytes[0] << 24 | (uint32_t)bytes[1] << 16 | (uint32_t)bytes[2] << 8 | bytes[3];
}

// --- Writing.

// Length, name and checksum around the `size` bytes behind the chunk's head. Returns the end.
static uint8_t *close_chunk(uint8_t *chunk, const char name[4], size_t size)
{
    put_u32(chunk, (uint32_t)size);
    memcpy(chunk + 4, name, 4);
    put_u32(chunk + CHUNK_HEAD_BYTES + size, libdeflate_crc32(0, chunk + 4, size + 4));
    return chunk + size + CHUNK_EXTRA_BYTES;
}

// Each row: the filter, then its bytes, big-endian ones, less those of the row above.
static void filter_rows(const Image *image, size_t row, uint8_t *to)
{
    bool swapped = image->kind == IMAGE_16 && htobe16(1) != 1;
    const uint8_t *here = image->pixels;
    for (int y = 0; y < image->height; ++y, here += row, to += row) {
        const uint8_t *above = y > 0 ? here - row : NULL;
        *to++ = FILTER_UP;
        if (!above)
            for (size_t i = 0; i < row; ++i) to[i] = here[i ^ swapped];
        else if (swapped)
            for (size_t i = 0; i < row; ++i) to[i] = (uint8_t)(here[i ^ 1] - above[i ^ 1]);
        else
            for (size_t i = 0; i < row; ++i) to[i] = (uint8_t)(here[i] - above[i]);
    }
}

static size_t write_file(uint8_t *file, size_t room, const Image *image,
                         struct libdeflate_compressor *compressor, const uint8_t *rows, size_t size)
{
    memcpy(file, SIGNATURE, sizeof SIGNATURE);
    uint8_t *at = file + sizeof SIGNATURE, *header = at + CHUNK_HEAD_BYTES;
    put_u32(header, (uint32_t)image->width);
    put_u32(header + 4, (uint32_t)image->height);
    header[8] = image->kind == IMAGE_16 ? 16 : 8;
    header[9] = color_type(image->channels);
    header[10] = header[11] = header[12] = 0; // deflate, the usual filters, not interlaced
    at = close_chunk(at, "IHDR", IHDR_BYTES);
    size_t packed = libdeflate_zlib_compress(compressor, rows, size, at + CHUNK_HEAD_BYTES, room);
    at = close_chunk(at, "IDAT", packed);
    return (size_t)(close_chunk(at, "IEND", 0) - file);
}

Result png_encode(const Image *image, Bytes *png, Error *error)
{
    size_t row = image_size(image) / (size_t)image->height;
    size_t size = (row + 1) * (size_t)image->height;
    *png = (Bytes){0};
    if (size >= ENCODE_MAX_BYTES)
        return error_set(error, RESULT_FAILED, "an image of %d x %d is too large for PNG here",
                         image->width, image->height);
    struct libdeflate_compressor *compressor = libdeflate_alloc_compressor(DEFLATE_LEVEL);
    size_t room = compressor ? libdeflate_zlib_compress_bound(compressor, size) : 0;
    uint8_t *rows = malloc(size), *file = malloc(room + END_BYTES + 1);
    Result result = RESULT_OK;
    if (compressor && rows && file) {
        filter_rows(image, row, rows);
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

Result png_write(const char *path, const Image *image, Error *error)
{
    Bytes png;
    Result result = png_encode(image, &png, error);
    if (result != RESULT_OK) return error_prefix(error, result, "%s: ", path);
    result = bytes_write_file(&png, path, error);
    bytes_destroy(&png);
    return result;
}

// --- Reading.

static Result fail_to_read(const char *path, Error *error)
{
    return error_set(error, RESULT_BAD_INPUT, "%s: not a readable PNG file: %s", path,
                     stbi_failure_reason());
}

static Result decode(Image *image, ImageKind kind, const Bytes *file, const char *path,
                     Error *error)
{
    Image found = {.kind = kind};
    int channels, size = (int)file->size;
    *image = (Image){0};
    if (file->size > INT_MAX)
        return error_set(error, RESULT_BAD_INPUT, "%s: larger than 2 GiB", path);
    if (!stbi_info_from_memory(file->data, size, &found.width, &found.height, &channels))
        return fail_to_read(path, error);
    if ((long long)found.width * found.height > READ_MAX_PIXELS)
        return error_set(error, RESULT_BAD_INPUT, "%s: %d x %d pixels, at most %d are read", path,
                         found.width, found.height, READ_MAX_PIXELS);
    found.channels = channels == 2 || channels == 4 ? 4 : 3;
    if (kind == IMAGE_16)
        found.pixels = (uint8_t *)stbi_load_16_from_memory(file->data, size, &found.width,
                                                           &found.height, NULL, found.channels);
    else
        found.pixels = stbi_load_from_memory(file->data, size, &found.width, &found.height, NULL,
                                             found.channels);
    if (!found.pixels) return fail_to_read(path, error);
    *image = found;
    return RESULT_OK;
}

Result png_decode_deep(Image *image, const Bytes *file, const char *path, Error *error)
{
    bool deep = file->size <= INT_MAX && stbi_is_16_bit_from_memory(file->data, (int)file->size);
    return decode(image, deep ? IMAGE_16 : IMAGE_8, file, path, error);
}

Result png_read(Image *image, const char *path, Error *error)
{
    *image = (Image){0};
    Bytes file;
    TRY(bytes_read_file(&file, path, error));
    Result result = decode(image, IMAGE_8, &file, path, error);
    bytes_destroy(&file);
    return result;
}

// --- Whole or not.

// The end of the chunk at `at`; 0 if the chunk isn't whole or its checksum is wrong.
static size_t chunk_end(const Bytes *file, size_t at)
{
    if (file->size - at < CHUNK_EXTRA_BYTES) return 0;
    size_t size = take_u32(file->data + at);
    if (size > file->size - at - CHUNK_EXTRA_BYTES) return 0;
    uint32_t sum = libdeflate_crc32(0, file->data + at + 4, size + 4);
    return sum == take_u32(file->data + at + CHUNK_HEAD_BYTES + size)
               ? at + CHUNK_EXTRA_BYTES + size
               : 0;
}

bool png_is_whole(const char *path, int width, int height, int channels)
{
    static const uint8_t head[CHUNK_HEAD_BYTES] = {0, 0, 0, IHDR_BYTES, 'I', 'H', 'D', 'R'};
    size_t at = sizeof SIGNATURE, begin = at + sizeof head;
    Bytes file;
    if (bytes_read_file(&file, path, NULL) != RESULT_OK) return false;
    const uint8_t *data = file.data;
    bool begun = file.size >= begin + IHDR_BYTES && memcmp(data, SIGNATURE, at) == 0 &&
                 memcmp(data + at, head, sizeof head) == 0 &&
                 take_u32(data + begin) == (uint32_t)width &&
                 take_u32(data + begin + 4) == (uint32_t)height && data[begin + 8] == 8 &&
                 data[begin + 9] == color_type(channels);
    bool ended = false;
    while (begun && !ended && at) {
        ended = file.size - at >= CHUNK_EXTRA_BYTES && memcmp(data + at + 4, "IEND", 4) == 0;
        at = chunk_end(&file, at);
    }
    bool whole = ended && at == file.size;
    bytes_destroy(&file);
    return whole;
}
