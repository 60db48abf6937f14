// SPDX-License-Identifier: MIT
#include "image/float_image.h"

#include "base/bytes.h"
#include "image/exr_file.h"
#include "image/hdr.h"
#include "image/jpeg.h"
#include "image/pfm.h"
#include "image/png.h"

#include "glsl/common/shared_math.h"

#include <math.h>
#include <stdlib.h>

Result float_image_read_image(Image *image, const char *path, Error *error)
{
    Bytes file;
    *image = (Image){0};
    TRY(bytes_read_file(&file, path, error));
    if (jpeg_is(&file)) {
        bytes_destroy(&file);
        return error_set(
            error, RESULT_BAD_INPUT,
            "%s: a JPEG file, whose compression changes pixels: expected PNG, EXR or PFM", path);
    }
    bool is_pfm = file.size > 1 && file.data[0] == 'P' && (file.data[1] | 0x20) == 'f';
    Result result = is_pfm               ? pfm_decode(image, &file, path, error)
                    : exr_file_is(&file) ? exr_file_decode(image, &file, path, error)
                    : hdr_is(&file)      ? hdr_decode(image, &file, path, error)
                                         : png_decode_deep(image, &file, path, error);
    bytes_destroy(&file);
    return result;
}

Result float_image_read_texts(ImageTexts *texts, const char *path, Error *error)
{
    Bytes file;
    *texts = (ImageTexts){0};
    TRY(bytes_read_file(&file, path, error));
    Result result = exr_file_is(&file) ? exr_file_decode_texts(texts, &file, path, error)
                                       : png_decode_texts(texts, &file, path, error);
    bytes_destroy(&file);
    return result;
}

// Sample `i` in levels 0..255; for alpha, too.
static double read_level(const Image *image, size_t i)
{
    if (image->kind == IMAGE_8) return image->pixels[i];
    return ((const uint16_t *)(const void *)image->pixels)[i] / 257.0;
}

// Like image_srgb_from_linear, but also for values outside 0..1, and in levels.
static double level_of_light(double linear)
{
    return 255 * copysign(srgb_encode(fabs(linear)), linear);
}

// Composites the pixel that begins with sample `i` over a grey background of `level`. In levels.
static void lay_over(const Image *image, size_t i, float level, float rgb[3])
{
    bool has_alpha = image->channels == 4;
    const float *light = (const float *)(const void *)image->pixels + i;
    if (image->kind == IMAGE_FLOAT) {
        double behind = has_alpha ? float_image_linear(level) * (1 - (double)light[3]) : 0;
        for (int k = 0; k < 3; ++k) rgb[k] = (float)level_of_light((double)light[k] + behind);
        return;
    }
    bool bytes = image->kind == IMAGE_8, clear = bytes && has_alpha && image->pixels[i + 3] == 0;
    if (clear || (bytes && (!has_alpha || image->pixels[i + 3] == 255))) {
        for (size_t k = 0; k < 3; ++k) rgb[k] = clear ? level : image->pixels[i + k];
        return;
    }
    double alpha = has_alpha ? read_level(image, i + 3) / 255 : 1;
    for (size_t k = 0; k < 3; ++k)
        rgb[k] = (float)(read_level(image, i + k) * alpha + (double)level * (1 - alpha));
}

Result float_image_create_area(FloatImage *floats, const Image *image, const int *nearest,
                               float level, ImageArea area, Error *error)
{
    size_t count = (size_t)area.width * (size_t)area.height, step = (size_t)image->channels;
    *floats = (FloatImage){.width = area.width, .height = area.height};
    floats->rgb = malloc(count * 3 * sizeof *floats->rgb);
    if (!floats->rgb) {
        *floats = (FloatImage){0};
        return error_set(error, RESULT_FAILED, "no memory to compare images of %d x %d",
                         image->width, image->height);
    }
    float *to = floats->rgb;
    for (int y = area.y; y < area.y + area.height; ++y)
        for (int x = area.x; x < area.x + area.width; ++x, to += 3) {
            size_t i = (size_t)y * (size_t)image->width + (size_t)x;
            lay_over(image, step * (nearest ? (size_t)nearest[i] : i), level, to);
        }
    return RESULT_OK;
}

Result float_image_create(FloatImage *floats, const Image *image, float level, Error *error)
{
    const ImageArea all = {0, 0, image->width, image->height};
    return float_image_create_area(floats, image, NULL, level, all, error);
}

void float_image_destroy(FloatImage *floats)
{
    free(floats->rgb);
    *floats = (FloatImage){0};
}

double float_image_linear(float level)
{
    return image_linear_from_srgb(fmin(fmax((double)level, 0), 255) / 255);
}
