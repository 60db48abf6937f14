// SPDX-License-Identifier: MIT
#include "image/hdr.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { MOST_PIXELS = 1 << 28, MOST_FACTOR = 64, SURE_BYTES = 64 << 20, LONGEST_ROW = 0x7fff };

bool hdr_is(const Bytes *file)
{
    return (file->size > 10 && memcmp(file->data, "#?RADIANCE", 10) == 0) ||
           (file->size > 6 && memcmp(file->data, "#?RGBE", 6) == 0);
}

typedef struct Header {
    int width, height;
    double exposure;
    size_t size; // bytes of the header
    const char *wrong;
} Header;

// Reads the lines up to the empty one and the line of the size after it.
static bool read_header(Header *header, const Bytes *file)
{
    const char *at = (const char *)file->data;
    *header = (Header){.exposure = 1, .wrong = "not a readable Radiance image"};
    for (bool empty = false; !empty;) {
        double exposure;
        const char *end = strchr(at, '\n');
        if (!end) return false;
        empty = end == at || (end == at + 1 && *at == '\r');
        if (sscanf(at, "EXPOSURE=%lf", &exposure) == 1 && exposure > 0 && isfinite(exposure))
            header->exposure *= exposure;
        if (strncmp(at, "FORMAT=32-bit_rle_xyze", 22) == 0) {
            header->wrong =
                "a Radiance image in XYZ colours: expected RGB (FORMAT=32-bit_rle_rgbe)";
            return false;
        }
        at = end + 1;
    }
    int length = 0;
    if (sscanf(at, "-Y %9d +X %9d%n", &header->height, &header->width, &length) != 2 ||
        at[length] != '\n' || header->width < 1 || header->height < 1) {
        header->wrong = "a Radiance image in another order of pixels: expected -Y HEIGHT +X WIDTH";
        return false;
    }
    header->size = (size_t)(at + length + 1 - (const char *)file->data);
    return true;
}

typedef struct Source {
    const uint8_t *at, *end;
} Source;

// A row in which each of the four channels is run-length encoded by itself.
static bool read_new_row(Source *source, uint8_t (*row)[4], int width)
{
    for (int channel = 0; channel < 4; ++channel)
        for (int x = 0; x < width;) {
            if (source->end - source->at < 2) return false;
            int count = *source->at++;
            bool run = count > 128;
            if (run) count -= 128;
            if (count == 0 || count > width - x || source->end - source->at < (run ? 1 : count))
                return false;
            for (int i = 0; i < count; ++i) row[x++][channel] = source->at[run ? 0 : i];
            source->at += run ? 1 : count;
        }
    return true;
}

// A row of pixels; 1, 1, 1, N repeats the one before N times, and a second one N << 8 times.
static bool read_old_row(Source *source, uint8_t (*row)[4], int width)
{
    int shift = 0;
    for (int x = 0; x < width;) {
        if (source->end - source->at < 4) return false;
        const uint8_t *pixel = source->at;
        source->at += 4;
        if (pixel[0] != 1 || pixel[1] != 1 || pixel[2] != 1) {
            memcpy(row[x++], pixel, 4);
            shift = 0;
            continue;
        }
        if (x == 0 || shift > 16) return false;
        for (int64_t i = (int64_t)pixel[3] << shift; i > 0 && x < width; --i, ++x)
            memcpy(row[x], row[x - 1], 4);
        shift += 8;
    }
    return true;
}

static bool read_row(Source *source, uint8_t (*row)[4], int width)
{
    const uint8_t *at = source->at;
    bool is_new = width >= 8 && width <= LONGEST_ROW && source->end - at >= 4 && at[0] == 2 &&
                  at[1] == 2 && (at[2] << 8 | at[3]) == width;
    if (!is_new) return read_old_row(source, row, width);
    source->at += 4;
    return read_new_row(source, row, width);
}

static bool read_pixels(Image *image, const Header *header, Source source)
{
    float *to = (float *)(void *)image->pixels;
    uint8_t(*row)[4] = malloc(4 * (size_t)header->width);
    bool good = row;
    for (int y = 0; y < header->height && good; ++y) {
        good = read_row(&source, row, header->width);
        for (int x = 0; x < header->width && good; ++x, to += 3) {
            double scale = row[x][3] ? ldexp(1, row[x][3] - 136) / header->exposure : 0;
            for (int k = 0; k < 3; ++k) to[k] = (float)fmin(row[x][k] * scale, 3e38);
        }
    }
    free(row);
    return good;
}

Result hdr_decode(Image *image, const Bytes *file, const char *path, Error *error)
{
    Header header;
    *image = (Image){0};
    if (!read_header(&header, file))
        return error_set(error, RESULT_BAD_INPUT, "%s: %s", path, header.wrong);
    long long count = (long long)header.width * header.height;
    if (count > MOST_PIXELS || 12 * (size_t)count > MOST_FACTOR * file->size + SURE_BYTES)
        return error_set(error, RESULT_BAD_INPUT,
                         "%s: %d x %d pixels: too many for a file of %zu bytes", path, header.width,
                         header.height, file->size);
    TRY(image_create_kind(image, header.width, header.height, 3, IMAGE_FLOAT, error));
    if (read_pixels(image, &header, (Source){file->data + header.size, file->data + file->size}))
        return RESULT_OK;
    image_destroy(image);
    return error_set(error, RESULT_BAD_INPUT, "%s: the Radiance image is cut off or damaged", path);
}
