// SPDX-License-Identifier: MIT
#include "support/studio.h"
#include "base/random.h"
#include "support/needed.h"
#include "support/plain.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

static const float EYE = 1000;

void studio_open(Studio *studio, const RendererOptions *options)
{
    memset(studio, 0, sizeof *studio);
    NEEDED(gpu_create(&studio->gpu, &(GpuOptions){0}, error));
    gpu_timer_create(&studio->timer, false, studio->gpu.software);
    studio_set_options(studio, options);
}

void studio_set_options(Studio *studio, const RendererOptions *options)
{
    renderer_destroy(&studio->renderer);
    image_destroy(&studio->image);
    NEEDED(renderer_create(&studio->renderer, &studio->gpu, &studio->timer, options, error));
    NEEDED(image_create_kind(&studio->image, options->width, options->height,
                             renderer_channels(&studio->renderer), options->kind, error));
}

int studio_rounding(const Studio *studio)
{
    return studio->gpu.software ? 1 : 2;
}

void studio_clear(Studio *studio)
{
    for (uint32_t i = 0; i < studio->count; ++i) {
        hair_destroy(&studio->hair[i]);
        params_destroy_section(&studio->material[i]);
    }
    studio->count = 0;
}

void studio_close(Studio *studio)
{
    studio_clear(studio);
    renderer_destroy(&studio->renderer);
    image_destroy(&studio->image);
    gpu_timer_destroy(&studio->timer);
    gpu_destroy(&studio->gpu);
}

void studio_make_plain(SectionParams *material, float opacity)
{
    material->ambient = 1;
    material->diffuse = material->specular1 = material->specular2 = 0;
    material->color_variation = 0;
    material->tip_ratio = 1;
    material->opacity = opacity;
    material->smooth = 1;
    for (int k = 0; k < 3; ++k) material->color[k] = 1;
}

uint32_t studio_add(Studio *studio, const Strands *strands, float radius, float opacity)
{
    uint32_t i = studio->count++, first_id = 0;
    assert_true(i < STUDIO_MAX_ITEMS);
    for (uint32_t k = 0; k < i; ++k) first_id += studio->hair[k].strand_count;
    SectionParams *material = &studio->material[i];
    plain_section(material);
    studio_make_plain(material, opacity);
    NEEDED(hair_create(&studio->hair[i], strands, first_id, &studio->gpu.limits, error));
    studio->items[i] =
        (RenderItem){.hair = &studio->hair[i], .material = material, .radius = radius};
    return i;
}

void studio_view(View *view, int width, int height)
{
    memset(view, 0, sizeof *view);
    view->eye[2] = EYE;
    view->near_distance = 10;
    view->far_distance = 10 * EYE;
    view->fov = 2 * atanf(0.5f * (float)height / EYE);
    glm_look(view->eye, (vec3){0, 0, -1}, (vec3){0, 1, 0}, view->view);
    glm_perspective(view->fov, (float)width / (float)height, view->near_distance,
                    view->far_distance, view->projection);
}

void studio_draw(Studio *studio)
{
    View view;
    studio_view(&view, studio->image.width, studio->image.height);
    studio_draw_view(studio, &view);
}

void studio_draw_view(Studio *studio, const View *view)
{
    RenderFrame frame = {.view = view,
                         .lights = &studio->light,
                         .light_count = studio->light.intensity != 0,
                         .head_rotation = {0, 0, 0, 1}};
    NEEDED(renderer_draw(&studio->renderer, &frame, studio->items, studio->count, &studio->image,
                         error));
}

const uint8_t *studio_pixel(const Studio *studio, int x, int y)
{
    const Image *image = &studio->image;
    return &image->pixels[((size_t)y * (size_t)image->width + (size_t)x) * (size_t)image->channels];
}

uint8_t *studio_copy(const Studio *studio, size_t *size)
{
    const Image *image = &studio->image;
    *size = image_size(image);
    uint8_t *copy = malloc(*size);
    assert_non_null(copy);
    return memcpy(copy, image->pixels, *size);
}

Strands studio_strands(uint32_t strand_count, uint32_t vertex_count, const float (*position)[3])
{
    Strands strands;
    NEEDED(strands_create(&strands, strand_count, strand_count * vertex_count, error));
    for (uint32_t s = 0; s <= strand_count; ++s) strands.first[s] = s * vertex_count;
    memcpy(strands.position, position, (size_t)strands.vertex_count * sizeof *position);
    return strands;
}

Strands studio_tangle(uint64_t seed, double side, uint32_t count, uint32_t vertices, double step,
                      double bend, const uint32_t *order)
{
    float(*position)[3] = malloc(count * vertices * sizeof *position);
    assert_non_null(position);
    Random random = random_create(seed, 0);
    for (uint32_t s = 0; s < count; ++s) {
        double x[3], d[3], turn[3];
        for (int k = 0; k < 3; ++k) x[k] = (random_real(&random) - 0.5) * side;
        random_direction(&random, d);
        random_direction(&random, turn);
        for (uint32_t j = 0; j < vertices; ++j)
            for (int k = 0; k < 3; ++k) {
                position[(order ? order[s] : s) * vertices + j][k] = (float)x[k];
                x[k] += step * d[k];
                d[k] += bend * turn[k];
            }
    }
    Strands strands = studio_strands(count, vertices, (const float(*)[3])position);
    free(position);
    return strands;
}
