// SPDX-License-Identifier: MIT
#include "image/png.h"

#include <libdeflate.h>
#include <limits.h>
#include <pthread.h>
#include <stdlib.h>
#include <string.h>

// Measured on frames of hair: the higher levels take half as long again for little or no gain in
// size.
#define DEFLATE_LEVEL 1
// The 'up' filter of the PNG specification, section 9.2: hair runs downwards, so the row above
// predicts well.
#define FILTER_UP        2
#define ENCODE_MAX_BYTES (1 << 30)
#define READ_MAX_PIXELS  (1 << 28)

static unsigned char *compress_zlib(const unsigned char *data, int size, int *compressed_size);

// Defined before the inclusion, they take the place of stb_image_write's own slower deflate and
// checksum.
#define STBIW_ZLIB_COMPRESS(data, size, out_size, quality) compress_zlib(data, size, out_size)
#define STBIW_CRC32(data, size)                            libdeflate_crc32(0, data, (size_t)(size))
#define STB_IMAGE_WRITE_IMPLEMENTATION
#define STBI_WRITE_NO_STDIO
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
#include <stb_image_write.h>
#pragma GCC diagnostic pop

// stb_image_write frees the result with free().
static unsigned char *compress_zlib(const unsigned char *data, int size, int *compressed_size)
{
    struct libdeflate_compressor *compressor = libdeflate_alloc_compressor(DEFLATE_LEVEL);
    if (!compressor) return NULL;
    size_t bound = libdeflate_zlib_compress_bound(compressor, (size_t)size);
    unsigned char *compressed = malloc(bound);
    size_t length = 0;
    if (compressed)
        length = libdeflate_zlib_compress(compressor, data, (size_t)size, compressed, bound);
    libdeflate_free_compressor(compressor);
    *compressed_size = (int)length;
    return compressed;
}

static void set_filter(void)
{
    stbi_write_force_png_filter = FILTER_UP;
}

Result png_encode(const Image *image, Bytes *png, Error *error)
{
    // The filter is a variable of stb_image_write; threads that encode at once must not all write
    // it.
    static pthread_once_t once = PTHREAD_ONCE_INIT;
    pthread_once(&once, set_filter);
    if (image->kind == IMAGE_16) return png_encode16(image, png, error);
    *png = (Bytes){0};
    size_t row = (size_t)image->width * (size_t)image->channels + 1;
    if (row * (size_t)image->height >= ENCODE_MAX_BYTES)
        return error_set(error, RESULT_FAILED, "an image of %d x %d is too large for PNG here",
                         image->width, image->height);
    int size = 0;
    unsigned char *data = stbi_write_png_to_mem(image->pixels, 0, image->width, image->height,
                                                image->channels, &size);
    unsigned char *terminated = data ? realloc(data, (size_t)size + 1) : NULL;
    if (!terminated) {
        free(data);
        return error_set(error, RESULT_FAILED, "no memory to encode an image of %d x %d",
                         image->width, image->height);
    }
    terminated[size] = 0;
    *png = (Bytes){.data = terminated, .size = (size_t)size};
    return RESULT_OK;
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

static Result fail_to_read(const char *path, Error *error)
{
    return error_set(error, RESULT_BAD_INPUT, "%s: not a readable PNG file: %s", path,
                     stbi_failure_reason());
}

// Size and channels (3 or 4) of a file of less than 2 GiB.
static Result look_at(Image *image, const Bytes *file, const char *path, Error *error)
{
    int channels;
    if (file->size > INT_MAX)
        return error_set(error, RESULT_BAD_INPUT, "%s: larger than 2 GiB", path);
    if (!stbi_info_from_memory(file->data, (int)file->size, &image->width, &image->height,
                               &channels))
        return fail_to_read(path, error);
    if ((long long)image->width * image->height > READ_MAX_PIXELS)
        return error_set(error, RESULT_BAD_INPUT, "%s: %d x %d pixels, at most %d are read", path,
                         image->width, image->height, READ_MAX_PIXELS);
    image->channels = channels == 2 || channels == 4 ? 4 : 3;
    return RESULT_OK;
}

static Result decode(Image *image, ImageKind kind, const Bytes *file, const char *path,
                     Error *error)
{
    Image found = {.kind = kind};
    *image = (Image){0};
    Result result = look_at(&found, file, path, error);
    if (result != RESULT_OK) return result;
    int size = (int)file->size;
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
    Result result = bytes_read_file(&file, path, error);
    if (result != RESULT_OK) return result;
    result = decode(image, IMAGE_8, &file, path, error);
    bytes_destroy(&file);
    return result;
}

// --- Whole or not, by the chunks of the PNG specification, section 5.

static uint32_t take_u32(const uint8_t *bytes)
{
    return (uint32_t)bytes[0] << 24 | (uint32_t)bytes[1] << 16 | (uint32_t)bytes[2] << 8 | bytes[3];
}

enum { CHUNK_EXTRA_BYTES = 12, SIGNATURE_BYTES = 8, IHDR_BYTES = 13 };

// The chunk at `at` with its checksum; bytes behind it, 0 if it isn't whole.
static size_t chunk_end(const Bytes *file, size_t at)
{
    if (file->size - at < CHUNK_EXTRA_BYTES) return 0;
    size_t size = take_u32(file->data + at);
    if (size > file->size - at - CHUNK_EXTRA_BYTES) return 0;
    uint32_t sum = libdeflate_crc32(0, file->data + at + 4, size + 4);
    return sum == take_u32(file->data + at + 8 + size) ? at + CHUNK_EXTRA_BYTES + size : 0;
}

static bool begins_with(const Bytes *file, int width, int height, int channels)
{
    static const uint8_t begin[] = {137, 'P', 'N', 'G',        13,  10,  26,  10,
                                    0,   0,   0,   IHDR_BYTES, 'I', 'H', 'D', 'R'};
    const uint8_t *data = file->data + sizeof begin;
    return file->size >= sizeof begin + IHDR_BYTES &&
           memcmp(file->data, begin, sizeof begin) == 0 && take_u32(data) == (uint32_t)width &&
           take_u32(data + 4) == (uint32_t)height && data[8] == 8 &&
           data[9] == (channels == 4 ? 6 : 2);
}

bool png_is_whole(const char *path, int width, int height, int channels)
{
    Bytes file;
    if (bytes_read_file(&file, path, NULL) != RESULT_OK) return false;
    bool begun = begins_with(&file, width, height, channels), ended = false;
    size_t at = SIGNATURE_BYTES;
    while (begun && !ended && at) {
        ended = file.size - at >= CHUNK_EXTRA_BYTES && memcmp(file.data + at + 4, "IEND", 4) == 0;
        at = chunk_end(&file, at);
    }
    bool whole = ended && at == file.size;
    bytes_destroy(&file);
    return whole;
}
