// SPDX-License-Identifier: MIT
#include "gen/studio_light.h"

#include "base/outfile.h"
#include "image/pfm.h"

#include <math.h>

typedef struct SoftBox {
    double way[3];            // unit, towards it; x to the right, y up, z towards the camera
    double radius_deg, light; // of a disc; radiance of its middle
} SoftBox;

// Where the studio look has its key, fill and rim light.
static const SoftBox BOXES[] = {
    {{-0.48, 0.64, 0.6}, 28, 6}, {{0.8, 0, 0.6}, 24, 1.6}, {{0.64, 0.48, -0.6}, 20, 5}};
static const double WALL = 0.12, CEILING = 0.2, FLOOR[3] = {0.14, 0.12, 0.1};

// 1 below `low`, 0 above `high`.
static double fade(double low, double high, double x)
{
    double t = fmin(fmax((x - low) / (high - low), 0), 1);
    return 1 - t * t * (3 - 2 * t);
}

static double find_light(const double way[3], int channel)
{
    double below = fade(-0.3, 0, way[1]), above = 1 - fade(0, 0.8, way[1]),
           light = WALL + below * (FLOOR[channel] - WALL) + above * (CEILING - WALL);
    for (size_t i = 0; i < sizeof BOXES / sizeof *BOXES; ++i) {
        const SoftBox *box = &BOXES[i];
        double cosine = way[0] * box->way[0] + way[1] * box->way[1] + way[2] * box->way[2],
               off = acos(fmin(cosine, 1)) * 180 / M_PI;
        light += box->light * fade(0.7 * box->radius_deg, 1.1 * box->radius_deg, off);
    }
    return light;
}

static void draw(Image *image)
{
    float *pixel = (float *)(void *)image->pixels;
    for (int y = 0; y < image->height; ++y)
        for (int x = 0; x < image->width; ++x) {
            double down = M_PI * (y + 0.5) / image->height,
                   turn = 2 * M_PI * ((x + 0.5) / image->width - 0.5);
            const double way[3] = {sin(down) * sin(turn), cos(down), -sin(down) * cos(turn)};
            for (int c = 0; c < 3; ++c)
                *pixel++ = (float)(floor(1024 * find_light(way, c) + 0.5) / 1024);
        }
}

Result studio_light_write(const char *path, Error *error)
{
    Image image;
    Bytes pfm = {0};
    OutFile file;
    TRY(image_create_kind(&image, 2 * STUDIO_LIGHT_HEIGHT, STUDIO_LIGHT_HEIGHT, 3, IMAGE_FLOAT,
                          error));
    draw(&image);
    Result result = pfm_encode(&image, &pfm, error);
    image_destroy(&image);
    THEN(result, outfile_open(&file, path, error));
    if (result == RESULT_OK) {
        fwrite(pfm.data, 1, pfm.size, file.stream);
        result = outfile_commit(&file, error);
    }
    bytes_destroy(&pfm);
    return result;
}
