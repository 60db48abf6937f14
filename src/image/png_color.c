// SPDX-License-Identifier: MIT
#include "image/png_color.h"

#include <endian.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { SIGNATURE_BYTES = 8, PRIMARIES_SRGB = 1, TRANSFER_LINEAR = 8, TRANSFER_SRGB = 13 };

typedef struct Colors {
    bool profile, srgb, coded;
    double gamma; // sample = light^gamma; 0: not given
    int primaries, transfer;
} Colors;

static uint32_t number_at(const uint8_t *at)
{
    uint32_t number;
    memcpy(&number, at, sizeof number);
    return be32toh(number);
}

// The chunks before the pixels. libpng has checked the file.
static Colors find_colors(const Bytes *file)
{
    Colors colors = {0};
    for (size_t at = SIGNATURE_BYTES; at + 12 <= file->size;) {
        const uint8_t *chunk = file->data + at, *content = chunk + 8;
        uint32_t length = number_at(chunk);
        if (length > file->size - at - 12 || memcmp(chunk + 4, "IDAT", 4) == 0) break;
        if (memcmp(chunk + 4, "sRGB", 4) == 0) colors.srgb = true;
        if (memcmp(chunk + 4, "iCCP", 4) == 0) colors.profile = true;
        if (memcmp(chunk + 4, "gAMA", 4) == 0 && length == 4)
            colors.gamma = number_at(content) / 1e5;
        if (memcmp(chunk + 4, "cICP", 4) == 0 && length == 4) {
            colors.coded = true;
            colors.primaries = content[0];
            colors.transfer = content[1];
        }
        at += 12 + (size_t)length;
    }
    return colors;
}

static double convert(double sample, double gamma)
{
    return image_srgb_from_linear(pow(sample, 1 / gamma));
}

static Result apply_gamma(Image *image, double gamma, Error *error)
{
    size_t levels = image->kind == IMAGE_16 ? 65536 : 256, channels = (size_t)image->channels;
    size_t count = (size_t)image->width * (size_t)image->height * channels;
    uint16_t *table = malloc(levels * sizeof *table), *deep = (uint16_t *)(void *)image->pixels;
    if (!table) return error_set(error, RESULT_FAILED, "no memory for a table of colours");
    for (size_t i = 0; i < levels; ++i) {
        double most = (double)(levels - 1);
        table[i] = (uint16_t)lround(most * convert((double)i / most, gamma));
    }
    for (size_t i = 0; i < count; ++i) {
        if (i % channels == 3) continue;
        if (image->kind == IMAGE_16)
            deep[i] = table[deep[i]];
        else
            image->pixels[i] = (uint8_t)table[image->pixels[i]];
    }
    free(table);
    return RESULT_OK;
}

Result png_color_convert(Image *image, const Bytes *file, const char *path, Error *error)
{
    const Colors colors = find_colors(file);
    const double usual = 1 / 2.2, near = 0.01; // gAMA of sRGB files
    if (colors.coded) {
        bool known = colors.primaries == PRIMARIES_SRGB &&
                     (colors.transfer == TRANSFER_LINEAR || colors.transfer == TRANSFER_SRGB ||
                      colors.transfer == 1 || colors.transfer == 6);
        if (!known)
            return error_set(error, RESULT_BAD_INPUT,
                             "%s: its colour space (cICP: primaries %d, transfer %d) is not read: "
                             "expected sRGB",
                             path, colors.primaries, colors.transfer);
        return colors.transfer == TRANSFER_LINEAR ? apply_gamma(image, 1, error) : RESULT_OK;
    }
    bool other = colors.gamma >= 0.05 && colors.gamma <= 20 && fabs(colors.gamma - usual) > near;
    if (colors.profile || colors.srgb || !other) return RESULT_OK;
    return apply_gamma(image, colors.gamma, error);
}
