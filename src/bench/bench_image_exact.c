// SPDX-License-Identifier: MIT
#include "bench/bench_image_exact.h"
#include "base/clock.h"
#include "bench/image_reference.h"
#include "bench/shadow_reference.h"
#include "strands/strands_resample.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

void image_exact_destroy(ImageExact *exact)
{
    for (int i = 0; i < 4; ++i) image_destroy(&exact->pictures[i / 2][i % 2].image);
    *exact = (ImageExact){0};
}

// The share of each light that reaches the vertices: [light_count][vertex_count], the caller's.
static Result find_left(const ReferenceScene *scene, const float middle[3], float **left,
                        Error *error)
{
    uint32_t count = scene->items[0].strands->vertex_count;
    *left = malloc((size_t)scene->light_count * count * sizeof **left);
    if (!*left) return error_set(error, RESULT_FAILED, "no memory for %u vertices' light", count);
    for (uint32_t i = 0; i < scene->light_count; ++i) {
        float *of_light = *left + (size_t)i * count;
        for (uint32_t v = 0; v < count; ++v) of_light[v] = 1;
        if (!scene->lights[i].shadow) continue;
        ShadowReference shadow;
        Result result = shadow_reference_create(&shadow, scene, &scene->lights[i], middle, error);
        if (result != RESULT_OK) return result;
        shadow_reference_fill(&shadow, &scene->items[0], of_light);
        shadow_reference_destroy(&shadow);
    }
    return RESULT_OK;
}

static Result draw(const ImageHair *hair, const ImageManner *manner, const Strands *strands,
                   Image *image, Error *error)
{
    float *left = NULL, middle[3];
    ReferenceItem item = {
        .strands = strands, .material = &manner->material, .radius = hair->radius};
    ReferenceScene scene = {.view = &hair->view,
                            .lights = hair->scene.lights,
                            .light_count = hair->scene.light_count,
                            .items = &item,
                            .item_count = 1,
                            .seed = hair->scene.run.seed};
    memcpy(scene.background, hair->scene.run.background, sizeof scene.background);
    for (int k = 0; k < 3; ++k) middle[k] = 0.5f * (hair->hair.low[k] + hair->hair.high[k]);
    Result result =
        manner->run.shadow != SHADOW_NONE ? find_left(&scene, middle, &left, error) : RESULT_OK;
    item.left = left;
    if (result == RESULT_OK)
        result = image_create(image, hair->scene.run.size[0], hair->scene.run.size[1], 3, error);
    if (result == RESULT_OK) result = image_reference_draw(image, &scene, REFERENCE_SIDE, error);
    free(left);
    return result;
}

// Strands with the points of their smooth curves as vertices, if the manner is such.
static Result smooth_strands(const ImageManner *manner, Strands *strands, Error *error)
{
    uint32_t parts = (uint32_t)manner->material.smooth;
    if (parts == 1) return RESULT_OK;
    const ResampleOptions resample = {.count = parts * (strands_size(strands, 0) - 1) + 1,
                                      .spline = true};
    return strands_resample(strands, &resample, error);
}

Result image_exact_find(ImageExact *exact, const ImageHair *hair, const ImageManner *manner,
                        const ImageExactPicture **found, Error *error)
{
    bool shadow = manner->run.shadow != SHADOW_NONE, smooth = manner->material.smooth > 1;
    ImageExactPicture *picture = &exact->pictures[shadow][smooth];
    *found = picture;
    if (picture->image.pixels) return RESULT_OK;
    Strands strands = {0};
    double begin = clock_ms();
    Result result = image_hair_read(&strands, hair->set, hair->file, error);
    if (result == RESULT_OK) result = smooth_strands(manner, &strands, error);
    if (result == RESULT_OK) result = draw(hair, manner, &strands, &picture->image, error);
    strands_destroy(&strands);
    picture->seconds = (clock_ms() - begin) / 1000;
    return result;
}

ImageDistance image_exact_compare(const ImageExactPicture *picture, const float background[3],
                                  const Image *image)
{
    uint8_t behind[3];
    size_t count = (size_t)image->width * (size_t)image->height, covered = 0;
    double sum = 0;
    for (int k = 0; k < 3; ++k) behind[k] = (uint8_t)lrintf(255 * background[k]);
    for (size_t i = 0; i < count; ++i) {
        const uint8_t *p = image->pixels + 3 * i, *q = picture->image.pixels + 3 * i;
        if (memcmp(p, behind, 3) == 0 && memcmp(q, behind, 3) == 0) continue;
        ++covered;
        for (int k = 0; k < 3; ++k) sum += (p[k] - q[k]) * (p[k] - q[k]) / 3.0;
    }
    return (ImageDistance){.rms = sqrt(sum / (double)(covered ? covered : 1)),
                           .covered = (double)covered / (double)count};
}
