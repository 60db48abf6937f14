// SPDX-License-Identifier: MIT
// The environment behind the hair: every pixel shows the light from its direction.
#include "draw/backdrop.h"

#include "base/parallel.h"
#include "support/needed.h"

#include <cglm/cglm.h>
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

enum { WIDTH = 37, HEIGHT = 23, SAMPLES = 2, ROWS = 32 };

static const EnvironmentAxes AXES = {{{0, 0, -1}, {0, 1, 0}, {1, 0, 0}}};

// A camera at `eye` that looks at the world's origin, and a light that no other direction has.
static DrawParams look_from(const float eye[3])
{
    mat4 view, projection;
    DrawParams draw = {.width = SAMPLES * WIDTH, .height = SAMPLES * HEIGHT};
    glm_lookat((vec3){eye[0], eye[1], eye[2]}, (vec3){0, 0, 0}, (vec3){0, 1, 0}, view);
    glm_perspective(0.9f, (float)WIDTH / HEIGHT, 0.1f, 10, projection);
    glm_mat4_mul(projection, view, projection);
    memcpy(draw.clip_from_world, projection, sizeof draw.clip_from_world);
    return draw;
}

static Environment make_environment(void)
{
    Image image;
    Environment environment = {0};
    NEEDED(image_create_kind(&image, 2 * ROWS, ROWS, 3, IMAGE_FLOAT, error));
    float *light = (float *)(void *)image.pixels;
    for (int y = 0; y < ROWS; ++y)
        for (int x = 0; x < 2 * ROWS; ++x, light += 3) {
            light[0] = 1 + (float)y, light[1] = 2 + sinf(0.1f * (float)x);
            light[2] = 2 + cosf(0.1f * (float)x);
        }
    NEEDED(environment_create(&environment, &image, error));
    environment.image = image;
    return environment;
}

// The direction of a pixel, by the inverse of the camera's matrix.
static void find_way(const DrawParams *draw, int x, int y, float way[3])
{
    mat4 clip_from_world = {{0}}, back;
    vec4 ends[2];
    memcpy(clip_from_world, draw->clip_from_world, sizeof clip_from_world);
    glm_mat4_inv(clip_from_world, back);
    for (int end = 0; end < 2; ++end) {
        vec4 clip = {((float)x + 0.5f) / WIDTH * 2 - 1, ((float)y + 0.5f) / HEIGHT * 2 - 1,
                     end ? 0.5f : -0.5f, 1};
        glm_mat4_mulv(back, clip, ends[end]);
    }
    for (int k = 0; k < 3; ++k) way[k] = ends[1][k] / ends[1][3] - ends[0][k] / ends[0][3];
}

static void assert_shows(const Backdrop *backdrop, const Ambient *ambient, float factor,
                         const DrawParams *draw)
{
    assert_true(backdrop->width == WIDTH && backdrop->height == HEIGHT);
    for (int y = 0; y < HEIGHT; ++y)
        for (int x = 0; x < WIDTH; ++x) {
            float way[3], light[3];
            find_way(draw, x, y, way);
            environment_look(ambient->environment, &AXES, way, light);
            const float *found = backdrop->light[y * WIDTH + x];
            for (int c = 0; c < 3; ++c) // 24 bits of the matrix; a row's light differs by 1
                if (!(fabsf(found[c] - factor * light[c]) < 2e-3f))
                    fail_msg("(%d, %d): light %d is %g: expected %g", x, y, c, (double)found[c],
                             (double)(factor * light[c]));
            assert_true(found[3] == 1);
        }
}

static void every_pixel_shows_its_direction(void **state)
{
    (void)state;
    Environment environment = make_environment();
    Ambient ambient = {.environment = &environment, .axes = AXES, .strength = 0.5f};
    RendererOptions options = {.samples = SAMPLES, .exposure = 1.5f};
    const float eyes[][3] = {{0, 1, 3}, {-2, -1, 1}, {0.5f, 3, -1}};
    for (int threads = 1; threads <= 3; ++threads) {
        Backdrop backdrop = {0};
        parallel_set_threads(threads);
        for (size_t i = 0; i < sizeof eyes / sizeof *eyes; ++i) {
            DrawParams draw = look_from(eyes[i]);
            for (int again = 0; again < 2; ++again) { // the same camera: kept
                NEEDED(backdrop_find(&backdrop, &ambient, &options, &draw, error));
                assert_int_equal(backdrop.version, i + 1);
                assert_shows(&backdrop, &ambient, 0.5f * exp2f(1.5f), &draw);
            }
        }
        backdrop_destroy(&backdrop);
    }
    parallel_set_threads(0);
    environment_destroy(&environment);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(every_pixel_shows_its_direction)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
