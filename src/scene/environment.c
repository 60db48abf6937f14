// SPDX-License-Identifier: MIT
#include "scene/environment.h"

#include "image/float_image.h"

#include <assert.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { ROWS = ENVIRONMENT_ROWS, COLUMNS = ENVIRONMENT_COLUMNS, PARTS = ENVIRONMENT_PARTS };

// --- From an image.

// What of pixel i of `count` lies between the shares low and high of the image, as the difference
// of `of` at its ends.
static double overlap(int i, int count, double low, double high, double (*of)(double))
{
    double from = fmax(low, (double)i / count), to = fmin(high, (double)(i + 1) / count);
    return to > from ? of(to) - of(from) : 0;
}

static double longitude(double share)
{
    return share;
}

// Areas of a sphere are as the differences of its heights.
static double height(double share)
{
    return -0.5 * cos(M_PI * share);
}

static void find_way(double turn, double up, float way[3])
{
    double wide = sqrt(fmax(1 - up * up, 0));
    way[0] = (float)(wide * sin(turn)), way[1] = (float)up, way[2] = (float)(-wide * cos(turn));
}

static void find_part(EnvironmentPart *part, const Image *image, int row, int column)
{
    double top = (double)row / ROWS, bottom = (double)(row + 1) / ROWS,
           left = (double)column / COLUMNS, right = (double)(column + 1) / COLUMNS;
    double sum[3] = {0}, all = 0;
    for (int y = (int)(top * image->height); y < (int)ceil(bottom * image->height); ++y) {
        double tall = overlap(y, image->height, top, bottom, height);
        for (int x = (int)(left * image->width); x < (int)ceil(right * image->width); ++x) {
            double area = tall * overlap(x, image->width, left, right, longitude);
            const float *pixel =
                (const float *)(const void *)image->pixels +
                (size_t)image->channels * ((size_t)y * (size_t)image->width + (size_t)x);
            for (int c = 0; c < 3; ++c) sum[c] += area * fmax((double)pixel[c], 0);
            all += area;
        }
    }
    *part = (EnvironmentPart){.share = (float)((height(bottom) - height(top)) / COLUMNS)};
    find_way(2 * M_PI * (0.5 * (left + right) - 0.5), -(height(top) + height(bottom)), part->way);
    for (int c = 0; c < 3; ++c) part->light[c] = (float)(sum[c] / all);
}

Result environment_create(Environment *environment, const Image *image, Error *error)
{
    environment->parts = malloc(PARTS * sizeof *environment->parts);
    if (!environment->parts) return error_set(error, RESULT_FAILED, "no memory for an environment");
    for (int i = 0; i < PARTS; ++i)
        find_part(&environment->parts[i], image, i / COLUMNS, i % COLUMNS);
    return RESULT_OK;
}

Result environment_read(Environment *environment, const char *path, bool keep, Error *error)
{
    Image image;
    *environment = (Environment){0};
    TRY(float_image_read_image(&image, path, error));
    Result result = RESULT_OK;
    if (image.kind != IMAGE_FLOAT)
        result = error_set(
            error, RESULT_BAD_INPUT,
            "%s: this image has no light above white: expected an .exr, .hdr or .pfm file", path);
    else if (image.width != 2 * image.height)
        result = error_set(error, RESULT_BAD_INPUT,
                           "%s: the image has %d x %d px: expected an equirectangular one, twice "
                           "as wide as high",
                           path, image.width, image.height);
    THEN(result, environment_create(environment, &image, error));
    if (result == RESULT_OK && keep)
        environment->image = image;
    else
        image_destroy(&image);
    return result;
}

void environment_destroy(Environment *environment)
{
    free(environment->parts);
    image_destroy(&environment->image);
    *environment = (Environment){0};
}

// --- To the scene.

static void to_world(const float own[3], const EnvironmentAxes *axes, float way[3])
{
    for (int k = 0; k < 3; ++k)
        way[k] = own[0] * axes->axis[0][k] + own[1] * axes->axis[1][k] + own[2] * axes->axis[2][k];
}

void environment_way(const EnvironmentAxes *axes, double turn, double up, float way[3])
{
    float own[3];
    find_way(turn, up, own);
    to_world(own, axes, way);
}

void environment_place(const Environment *environment, const EnvironmentAxes *axes,
                       const float way[3], float place[2])
{
    float own[3];
    for (int k = 0; k < 3; ++k)
        own[k] = axes->axis[k][0] * way[0] + axes->axis[k][1] * way[1] + axes->axis[k][2] * way[2];
    float turn = atan2f(own[0], -own[2]), down = atan2f(hypotf(own[0], own[2]), own[1]);
    place[0] = (turn / (2 * (float)M_PI) + 0.5f) * (float)environment->image.width;
    place[1] = down / (float)M_PI * (float)environment->image.height;
}

// The pixel before `at` (px from the middle of the first pixel) and the weight of the next.
static int find_pixel(float at, float *weight)
{
    float whole = floorf(at);
    *weight = at - whole;
    return (int)whole;
}

void environment_look(const Environment *environment, const EnvironmentAxes *axes,
                      const float way[3], float light[3])
{
    const Image *image = &environment->image;
    const float *pixels = (const float *)(const void *)image->pixels;
    float place[2], weight[2];
    environment_place(environment, axes, way, place);
    int width = image->width, last = image->height - 1, x = find_pixel(place[0] - 0.5f, &weight[0]),
        y = find_pixel(place[1] - 0.5f, &weight[1]);
    for (int c = 0; c < 3; ++c) light[c] = 0;
    for (int q = 0; q < 4; ++q) {
        int column = (x + (q & 1) + width) % width, row = y + (q >> 1);
        row = row < 0 ? 0 : row > last ? last : row;
        float share = (q & 1 ? weight[0] : 1 - weight[0]) * (q >> 1 ? weight[1] : 1 - weight[1]);
        const float *pixel =
            pixels + (size_t)image->channels * ((size_t)row * (size_t)width + (size_t)column);
        for (int c = 0; c < 3; ++c) light[c] += share * fmaxf(pixel[c], 0);
    }
}

static void find_basis(const float n[3], double basis[ENVIRONMENT_TERMS])
{
    const double x = (double)n[0], y = (double)n[1], z = (double)n[2];
    const double values[ENVIRONMENT_TERMS] = {
        1, y, x, z, x * y, y * z, z * x, x * x - z * z, 3 * y * y - 1};
    memcpy(basis, values, sizeof values);
}

// The part of the light that a function of the basis carries is its mean product with it over the
// function's mean square. Of light by degree 0, 1 and 2 a matt surface shows 1, 2/3 and 1/4.
// Functions that sum to nothing over the sphere do so over the parts, too, once their mean over
// those is taken off.
void environment_around(const Environment *environment, const EnvironmentAxes *axes,
                        float terms[ENVIRONMENT_TERMS][3])
{
    enum { N = ENVIRONMENT_TERMS };
    static const double SHOWN[N] = {1,           2. / 3 * 3,      2. / 3 * 3,
                                    2. / 3 * 3,  1. / 4 * 15,     1. / 4 * 15,
                                    1. / 4 * 15, 1. / 4 * 15 / 4, 1. / 4 * 5 / 4};
    double sum[N][3] = {{0}}, mean[N] = {0};
    for (int i = 0; i < PARTS; ++i) {
        const EnvironmentPart *part = &environment->parts[i];
        float way[3];
        double basis[N];
        to_world(part->way, axes, way);
        find_basis(way, basis);
        for (int t = 0; t < N; ++t) {
            double weight = (double)part->share * basis[t];
            mean[t] += weight;
            for (int c = 0; c < 3; ++c) sum[t][c] += weight * (double)part->light[c];
        }
    }
    for (int t = 0; t < N; ++t)
        for (int c = 0; c < 3; ++c)
            terms[t][c] = (float)(SHOWN[t] * (sum[t][c] - (t ? mean[t] * sum[0][c] : 0)));
}

// The cosine up to which a direction takes light. 48 directions lie some 30 degrees apart.
static const float REACH = 0.82f;

// Each part is shared out among the directions around it.
void environment_spread(const Environment *environment, const EnvironmentAxes *axes,
                        const float (*way)[3], int count, float (*light)[3])
{
    enum { MOST = ENVIRONMENT_DIRECTIONS };
    double sum[MOST][4] = {{0}}, all[3] = {0}, spread[3] = {0};
    float weight[MOST];
    assert(count <= MOST);
    for (int i = 0; i < PARTS; ++i) {
        const EnvironmentPart *part = &environment->parts[i];
        float at[3], weights = 0;
        to_world(part->way, axes, at);
        for (int d = 0; d < count; ++d) {
            float near = way[d][0] * at[0] + way[d][1] * at[1] + way[d][2] * at[2] - REACH;
            weight[d] = near > 0 ? near * near : 0;
            weights += weight[d];
        }
        for (int c = 0; c < 3; ++c) all[c] += (double)part->share * (double)part->light[c];
        for (int d = 0; d < count && weights > 0; ++d) {
            double share = (double)part->share * (double)(weight[d] / weights);
            for (int c = 0; c < 3; ++c) sum[d][c] += share * (double)part->light[c];
            sum[d][3] += share;
        }
    }
    for (int d = 0; d < count; ++d)
        for (int c = 0; c < 3; ++c) spread[c] += sum[d][c] / fmax(sum[d][3], 1e-12) / (double)count;
    for (int d = 0; d < count; ++d)
        for (int c = 0; c < 3; ++c)
            light[d][c] =
                (float)(sum[d][c] / fmax(sum[d][3], 1e-12) * all[c] / fmax(spread[c], 1e-30));
}
