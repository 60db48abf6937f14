// SPDX-License-Identifier: MIT
#include "image/heat_map.h"

#include "image/float_image.h"

#include <limits.h>
#include <math.h>
#include <string.h>

// Colours at equal steps. Their CIE L* is 0, 25, 50, 75 and 98, to within 2.
static const float STOPS[][3] = {
    {0, 0, 2}, {88, 30, 120}, {200, 62, 110}, {252, 159, 106}, {254, 250, 205}};
enum { STOP_COUNT = sizeof STOPS / sizeof *STOPS, GAP_PX = 4, CHECK_PX = 8, STRIPE_PX = 4 };

void heat_map_color(uint8_t rgb[3], float error)
{
    float place = fminf(fmaxf(error, 0), 1) * (STOP_COUNT - 1);
    int stop = place >= STOP_COUNT - 1 ? STOP_COUNT - 2 : (int)place;
    float share = place - (float)stop;
    for (int k = 0; k < 3; ++k)
        rgb[k] = (uint8_t)lrintf(STOPS[stop][k] + share * (STOPS[stop + 1][k] - STOPS[stop][k]));
}

void heat_map_round(float *errors, size_t count)
{
    enum { LAST = HEAT_MAP_STEPS - 1 };
    for (size_t i = 0; i < count; ++i) {
        float step = rintf(fminf(errors[i], 1) * LAST);
        if (!isnan(errors[i])) errors[i] = (errors[i] > 0 ? fmaxf(step, 1) : 0) / LAST;
    }
}

Result heat_map_create(Image *image, const float *errors, int width, int height, Error *error)
{
    TRY(image_create(image, width, height, 3, error));
    for (size_t i = 0; i < (size_t)width * (size_t)height; ++i) {
        uint8_t *rgb = image->pixels + 3 * i;
        size_t diagonal = i % (size_t)width + i / (size_t)width;
        if (isnan(errors[i]))
            memset(rgb, diagonal / STRIPE_PX % 2 ? 144 : 96, 3);
        else
            heat_map_color(rgb, errors[i]);
    }
    return RESULT_OK;
}

// --- The sheet.

// Draws the image over a checkerboard of light and dark grey.
static Result put_image(Image *sheet, int left, const Image *image, Error *error)
{
    FloatImage dark = {0}, light = {0};
    Result result = float_image_create(&dark, image, 102, error);
    THEN(result, float_image_create(&light, image, 153, error));
    for (size_t y = 0; y < (size_t)image->height && result == RESULT_OK; ++y)
        for (size_t x = 0; x < (size_t)image->width; ++x) {
            const FloatImage *ground = (x / CHECK_PX + y / CHECK_PX) % 2 ? &light : &dark;
            const float *from = ground->rgb + 3 * (y * (size_t)image->width + x);
            uint8_t *to = sheet->pixels + 3 * (y * (size_t)sheet->width + (size_t)left + x);
            for (int k = 0; k < 3; ++k) to[k] = (uint8_t)lrintf(fminf(fmaxf(from[k], 0), 255));
        }
    float_image_destroy(&dark);
    float_image_destroy(&light);
    return result;
}

Result heat_map_create_sheet(Image *sheet, const Image *a, const Image *b, const float *errors,
                             Error *error)
{
    int width = a->width, height = a->height, step = width + GAP_PX;
    Image map = {0};
    *sheet = (Image){0};
    if (width > (INT_MAX - 2 * GAP_PX) / 3)
        return error_set(error, RESULT_FAILED, "images of %d pixels are too wide for a sheet",
                         width);
    TRY(image_create(sheet, 3 * width + 2 * GAP_PX, height, 3, error));
    memset(sheet->pixels, 255, image_size(sheet));
    Result result = put_image(sheet, 0, a, error);
    THEN(result, put_image(sheet, step, b, error));
    THEN(result, heat_map_create(&map, errors, width, height, error));
    THEN(result, put_image(sheet, 2 * step, &map, error));
    image_destroy(&map);
    if (result != RESULT_OK) image_destroy(sheet);
    return result;
}
