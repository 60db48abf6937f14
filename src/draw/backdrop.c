// SPDX-License-Identifier: MIT
#include "draw/backdrop.h"

#include "base/parallel.h"
#include "base/room.h"
#include "draw/rays.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

typedef struct Fill {
    Backdrop *backdrop;
    const Ambient *ambient;
    float light; // factor of the environment's
    Rays rays;
    int samples; // of a pixel's side
    int parts;
} Fill;

static void fill_rows(void *data, int part)
{
    const Fill *fill = data;
    const Backdrop *backdrop = fill->backdrop;
    const Rays *rays = &fill->rays;
    for (int y = part; y < backdrop->height; y += fill->parts)
        for (int x = 0; x < backdrop->width; ++x) {
            float *light = backdrop->light[(size_t)y * (size_t)backdrop->width + (size_t)x];
            const float u = ((float)x + 0.5f) * (float)fill->samples,
                        v = ((float)y + 0.5f) * (float)fill->samples;
            float way[3];
            for (int k = 0; k < 3; ++k)
                way[k] = u * rays->across[k] + v * rays->down[k] + rays->from[k];
            environment_look(fill->ambient->environment, &fill->ambient->axes, way, light);
            for (int c = 0; c < 3; ++c) light[c] *= fill->light;
            light[3] = 1;
        }
}

// Whether camera, environment and exposure are those of the last image. (The terms of an
// environment change with each of its properties, and with its axes.)
static bool is_same(const DrawParams *a, const DrawParams *b)
{
    return a->width == b->width && a->height == b->height &&
           memcmp(a->clip_from_world, b->clip_from_world, sizeof a->clip_from_world) == 0 &&
           memcmp(a->sky, b->sky, sizeof a->sky) == 0 &&
           memcmp(a->ground, b->ground, sizeof a->ground) == 0 &&
           memcmp(a->around, b->around, sizeof a->around) == 0;
}

Result backdrop_find(Backdrop *backdrop, const Ambient *ambient, const RendererOptions *options,
                     const DrawParams *draw, Error *error)
{
    int width = (int)draw->width / options->samples, height = (int)draw->height / options->samples;
    size_t count = (size_t)width * (size_t)height;
    if (backdrop->version && is_same(&backdrop->drawn, draw)) return RESULT_OK;
    if (!room_make(&backdrop->light, &backdrop->room, count, sizeof *backdrop->light))
        return error_set(error, RESULT_FAILED, "no memory for the background: %d x %d px", width,
                         height);
    backdrop->width = width;
    backdrop->height = height;
    Fill fill = {.backdrop = backdrop,
                 .ambient = ambient,
                 .light = ambient->strength * exp2f(options->exposure),
                 .rays = rays_find(draw),
                 .samples = options->samples,
                 .parts = parallel_threads()};
    parallel_run(fill.parts, fill_rows, &fill);
    backdrop->drawn = *draw;
    ++backdrop->version;
    return RESULT_OK;
}

void backdrop_destroy(Backdrop *backdrop)
{
    free(backdrop->light);
    *backdrop = (Backdrop){0};
}
