// SPDX-License-Identifier: MIT
// The path tracer of light among strands: a single fibre against the twin of the fibre's equations,
// and a bundle that absorbs nothing in a white surrounding, where it is invisible.
#include "base/parallel.h"
#include "reference/light_reference.h"
#include "support/reference_marschner.h"

#include <cglm/cglm.h>

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

enum { SIDE = 16, PIXELS = SIDE * SIDE, CHANNELS = 4 };
static const double ROUGHNESS = 0.08, SPREAD = 0.3, REFRACTION = 1.55;
static const double COLOR[3] = {0.9, 0.6, 0.2}, DARK[3] = {0.1, 0.05, 0.02}, WHITE[3] = {1, 1, 1};

typedef struct Scenery {
    Strands strands;
    LightReferenceItem item;
    View view;
    Light light;
    float sky[3], ground[3];
    LightReferenceScene scene;
    Image image;
} Scenery;

// Strands of `length` along `way` through the points of a square lattice around the origin, seen
// from z = 2 m in a window of 4 mm.
static void open_scenery(Scenery *s, int across, const double way[3], double radius,
                         const double color[3])
{
    Error error;
    const double length = 1, apart = 2.5 * radius;
    memset(s, 0, sizeof *s);
    uint32_t count = (uint32_t)(across * across);
    assert_int_equal(strands_create(&s->strands, count, 2 * count, &error), RESULT_OK);
    for (uint32_t i = 0; i < count; ++i) {
        const double at[3] = {((double)(i % (uint32_t)across) - 0.5 * (across - 1)) * apart,
                              ((double)(i / (uint32_t)across) - 0.5 * (across - 1)) * apart,
                              ((double)((7 * i) % count) - 0.5 * (count - 1)) * apart / across};
        s->strands.first[i + 1] = 2 * (i + 1);
        for (int end = 0; end < 2; ++end)
            for (int k = 0; k < 3; ++k)
                s->strands.position[2 * i + (uint32_t)end][k] =
                    (float)(at[k] + (end - 0.5) * length * way[k]);
    }
    s->item = (LightReferenceItem){&s->strands, radius,
                                   fibre_reference_create(REFRACTION, ROUGHNESS, SPREAD, color)};
    s->view = (View){.eye = {0, 0, 2}, .fov = 0.002f};
    glm_lookat(s->view.eye, (vec3){0, 0, 0}, (vec3){0, 1, 0}, s->view.view);
    s->scene = (LightReferenceScene){.items = &s->item,
                                     .item_count = 1,
                                     .view = &s->view,
                                     .lights = &s->light,
                                     .sky = s->sky,
                                     .ground = s->ground};
    assert_int_equal(image_create_kind(&s->image, SIDE, SIDE, CHANNELS, IMAGE_FLOAT, &error),
                     RESULT_OK);
}

static void close_scenery(Scenery *s)
{
    strands_destroy(&s->strands);
    image_destroy(&s->image);
}

static void draw(Scenery *s, int orders, int paths)
{
    Error error;
    assert_int_equal(light_reference_draw(&s->image, &s->scene, orders, paths, 3, &error),
                     RESULT_OK);
}

// Mean of a channel where there is hair.
static double mean_light(const Scenery *s, int channel)
{
    const float *pixels = (const float *)(const void *)s->image.pixels;
    double light = 0, coverage = 0;
    for (int i = 0; i < PIXELS; ++i) {
        light += (double)pixels[CHANNELS * i + channel];
        coverage += (double)pixels[CHANNELS * i + 3];
    }
    assert_true(coverage > 0.1 * PIXELS);
    return light / coverage;
}

// The fibre's density by the twin.
static double twin_density(double sine_r, double sine_i, double azimuth, double color)
{
    const double WIDTH[LOBE_COUNT] = {1, 0.5, 2};
    double around[LOBE_COUNT], sum = 0;
    marschner_azimuthal(REFRACTION, SPREAD, sqrt(1 - sine_r * sine_r), color, azimuth, 60, around);
    for (int p = 0; p < LOBE_COUNT; ++p)
        sum +=
            around[p] * marschner_longitudinal(asin(sine_i), asin(sine_r), 0, ROUGHNESS * WIDTH[p]);
    return sum;
}

// Light of a sun: 35,000 paths meet the fibre, and the standard deviation of their light is at most
// 3 times its mean, so 5 % are 3 standard deviations of the mean.
static void fibre_shows_the_twin_s_light(void **state)
{
    (void)state;
    Scenery s;
    open_scenery(&s, 1, (const double[]){1, 0, 0}, 0.001, COLOR);
    const double to_light[3] = {0.1, 0.75, 0.6538};
    s.light = (Light){.kind = LIGHT_DIRECTIONAL, .intensity = 0.7f, .color = {1, 1, 1}};
    for (int k = 0; k < 3; ++k) s.light.direction[k] = (float)to_light[k];
    s.scene.light_count = 1;
    draw(&s, 8, 300);
    for (int c = 0; c < 3; ++c) {
        double right =
            0.7 * M_PI * twin_density(0, to_light[0], atan2(to_light[1], to_light[2]), COLOR[c]);
        assert_true(fabs(mean_light(&s, c) / right - 1) < 0.05);
    }
    close_scenery(&s);
}

// Light from a sky that grows from 0 below to 1 above, for which directions are drawn. Its values
// lie between 0 and 1, so the standard deviation of the mean of 35,000 paths is below 0.5 / 187 =
// 0.0027. The fibre leans towards the eye, so that most light comes from one side.
static void require_density(const double color[3])
{
    enum { STEPS = 40, TURNS = 60 };
    Scenery s;
    open_scenery(&s, 1, (const double[]){0, 0.8, 0.6}, 0.001, color);
    for (int c = 0; c < 3; ++c) s.sky[c] = 1;
    draw(&s, 8, 300);
    for (int c = 0; c < 3; ++c) {
        double right = 0;
        for (int i = 0; i < STEPS; ++i)
            for (int j = 0; j < TURNS; ++j) {
                // Axes: along the fibre, towards the eye across it (0, -0.6, 0.8), x. Both sides of
                // the fibre are alike.
                double sine = 2 * (i + 0.5) / STEPS - 1, turn = M_PI * (j + 0.5) / TURNS,
                       up = 0.8 * sine - 0.6 * sqrt(1 - sine * sine) * cos(turn);
                right += twin_density(0.6, sine, turn, color[c]) * (0.5 + 0.5 * up) * 4 * M_PI /
                         (STEPS * TURNS);
            }
        assert_true(fabs(mean_light(&s, c) - right) < 0.008);
    }
    close_scenery(&s);
}

static void drawn_directions_have_the_density(void **state)
{
    (void)state;
    require_density(COLOR);
}

static void faint_paths_that_end_are_made_up_for(void **state)
{
    (void)state;
    require_density(DARK);
}

// The second strand is 2 cm above the first one, out of sight, and begins at x = 0.5 mm.
static void fibre_is_dark_only_behind_another(void **state)
{
    (void)state;
    Scenery s;
    open_scenery(&s, 2, (const double[]){1, 0, 0}, 0.0004, COLOR);
    for (uint32_t i = 0; i < s.strands.vertex_count; ++i)
        memset(s.strands.position[i], 0, sizeof s.strands.position[i]);
    for (int end = 0; end < 2; ++end) {
        s.strands.position[end][0] = (float)end - 0.5f;
        s.strands.position[2 + end][0] = end ? 0.5f : 0.0005f;
        s.strands.position[2 + end][1] = 0.02f;
    }
    s.light = (Light){
        .kind = LIGHT_DIRECTIONAL, .intensity = 1, .color = {1, 1, 1}, .direction = {0, 1, 0}};
    s.scene.light_count = 1;
    draw(&s, 1, 20);
    const float *pixels = (const float *)(const void *)s.image.pixels;
    double light[SIDE] = {0};
    for (int i = 0; i < PIXELS; ++i) light[i % SIDE] += (double)pixels[CHANNELS * i];
    for (int x = 0; x < SIDE; ++x) {
        if (x <= 8) assert_true(light[x] > 0);   // to x = 0.25 mm
        if (x >= 11) assert_true(light[x] == 0); // from x = 0.75 mm
    }
    close_scenery(&s);
}

static void white_bundle_is_invisible(void **state)
{
    (void)state;
    Scenery s;
    open_scenery(&s, 5, (const double[]){0, 0.8, 0.6}, 0.0003, WHITE);
    for (int c = 0; c < 3; ++c) s.sky[c] = s.ground[c] = 1;
    draw(&s, 1000, 4);
    const float *pixels = (const float *)(const void *)s.image.pixels;
    for (int i = 0; i < PIXELS; ++i)
        for (int c = 0; c < 3; ++c)
            assert_true(fabsf(pixels[CHANNELS * i + c] - pixels[CHANNELS * i + 3]) < 1e-5f);
    draw(&s, 1, 4);
    assert_true(mean_light(&s, 0) < 0.9); // light that meets a second fibre is left out
    close_scenery(&s);
}

static void threads_do_not_matter(void **state)
{
    (void)state;
    Scenery s;
    Image first;
    Error error;
    open_scenery(&s, 3, (const double[]){0, 0.8, 0.6}, 0.0003, COLOR);
    for (int c = 0; c < 3; ++c) s.sky[c] = 1;
    parallel_set_threads(1);
    draw(&s, 8, 2);
    assert_int_equal(image_create_kind(&first, SIDE, SIDE, CHANNELS, IMAGE_FLOAT, &error),
                     RESULT_OK);
    memcpy(first.pixels, s.image.pixels, image_size(&first));
    parallel_set_threads(3);
    draw(&s, 8, 2);
    parallel_set_threads(0);
    assert_memory_equal(first.pixels, s.image.pixels, image_size(&first));
    image_destroy(&first);
    close_scenery(&s);
}

static void lamps_are_refused(void **state)
{
    (void)state;
    Scenery s;
    Error error;
    open_scenery(&s, 1, (const double[]){1, 0, 0}, 0.001, COLOR);
    s.light = (Light){.kind = LIGHT_POINT};
    s.scene.light_count = 1;
    assert_int_equal(light_reference_draw(&s.image, &s.scene, 1, 1, 0, &error), RESULT_USAGE);
    s.light = (Light){.kind = LIGHT_DIRECTIONAL, .direction = {0, 1, 0}, .radius = 1};
    assert_int_equal(light_reference_draw(&s.image, &s.scene, 1, 1, 0, &error), RESULT_USAGE);
    close_scenery(&s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(fibre_shows_the_twin_s_light),
        cmocka_unit_test(drawn_directions_have_the_density),
        cmocka_unit_test(faint_paths_that_end_are_made_up_for),
        cmocka_unit_test(fibre_is_dark_only_behind_another),
        cmocka_unit_test(white_bundle_is_invisible),
        cmocka_unit_test(threads_do_not_matter),
        cmocka_unit_test(lamps_are_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
