// SPDX-License-Identifier: MIT
// The path tracer of light among strands: a single fibre against the twin of the fibre's equations,
// in sharp and wide lights and in an environment, and a bundle that absorbs nothing in a white
// surrounding, where it is invisible.
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

// The fibre along x, seen from z, in the light of radiance 1 of a cone around `way`, of which
// `wide` is the tangent of the angular radius: a midpoint rule.
static double disc_light(const double way[3], double wide, double color)
{
    enum { RINGS = 12, TURNS = 24 };
    const double least = 1 / sqrt(1 + wide * wide);
    double sum = 0;
    vec3 side, up, middle = {(float)way[0], (float)way[1], (float)way[2]};
    glm_vec3_ortho(middle, side);
    glm_vec3_normalize(side);
    glm_vec3_cross(middle, side, up);
    for (int i = 0; i < RINGS; ++i)
        for (int j = 0; j < TURNS; ++j) {
            double w = 1 - (i + 0.5) / RINGS * (1 - least), off = sqrt(1 - w * w), at[3],
                   turn = 2 * M_PI * j / TURNS;
            for (int k = 0; k < 3; ++k)
                at[k] =
                    w * way[k] + off * (cos(turn) * (double)side[k] + sin(turn) * (double)up[k]);
            sum += twin_density(0, at[0], atan2(at[1], at[2]), color);
        }
    return sum * 2 * M_PI * (1 - least) / (RINGS * TURNS);
}

// A light of radius tan(20 degrees) per distance shows a matt surface that faces it as 1, so its
// radiance is 1 / sin^2(20 degrees). As in fibre_shows_the_twin_s_light, 5 % are 3 standard
// deviations or more.
static void require_wide(const Light *light, double share)
{
    const double way[3] = {0.1, 0.75, 0.6538}, wide = tan(M_PI / 9), sine = sin(M_PI / 9);
    Scenery s;
    open_scenery(&s, 1, (const double[]){1, 0, 0}, 0.001, COLOR);
    s.light = *light;
    s.scene.light_count = 1;
    draw(&s, 8, 300);
    for (int c = 0; c < 3; ++c) {
        double right = share / (sine * sine) * disc_light(way, wide, COLOR[c]);
        if (!(fabs(mean_light(&s, c) / right - 1) < 0.05))
            fail_msg("channel %d: %g, expected %g", c, mean_light(&s, c), right);
    }
    close_scenery(&s);
}

static void wide_lights_show_the_twin_s_light(void **state)
{
    (void)state;
    const float wide = (float)tan(M_PI / 9);
    Light light = {.kind = LIGHT_DIRECTIONAL,
                   .direction = {0.1f, 0.75f, 0.6538f},
                   .intensity = 0.5f,
                   .color = {1, 1, 1},
                   .radius = 20};
    require_wide(&light, 0.5);
    // Twice as far as its intensity is stated for.
    light.kind = LIGHT_POINT, light.distance = 1, light.radius = 2 * wide;
    for (int k = 0; k < 3; ++k) light.position[k] = 2 * light.direction[k];
    require_wide(&light, 0.5 / 4);
    // Its axis is 30 degrees off. The factor falls with the cosine, from 1 at 0 to 0 at 60 degrees,
    // and is squared.
    const vec3 axis = {-0.1f, -0.75f, -0.6538f};
    vec3 tilted, about = {1, 0, 0};
    glm_vec3_copy((float *)axis, tilted);
    glm_vec3_crossn(tilted, about, about);
    glm_vec3_rotate(tilted, (float)M_PI / 6, about);
    memcpy(light.direction, tilted, sizeof light.direction);
    light.kind = LIGHT_SPOT, light.inner_deg = 0, light.outer_deg = 60;
    require_wide(&light, 0.5 / 4 * pow((sqrt(0.75) - 0.5) / 0.5, 2));
}

// The second strand lies 2 cm above the first one.
static void hair_behind_a_lamp_hides_nothing(void **state)
{
    (void)state;
    Scenery s;
    open_scenery(&s, 2, (const double[]){1, 0, 0}, 0.0004, COLOR);
    for (uint32_t i = 0; i < s.strands.vertex_count; ++i) {
        memset(s.strands.position[i], 0, sizeof s.strands.position[i]);
        s.strands.position[i][0] = (float)(i % 2) - 0.5f;
        s.strands.position[i][1] = i / 2 == 1 ? 0.02f : 0;
    }
    s.light = (Light){.kind = LIGHT_POINT, .intensity = 1, .color = {1, 1, 1}, .distance = 1};
    s.scene.light_count = 1;
    s.light.position[1] = 0.01f;
    draw(&s, 1, 4);
    assert_true(mean_light(&s, 0) > 0);
    s.light.position[1] = 0.03f;
    draw(&s, 1, 4);
    assert_true(mean_light(&s, 0) == 0);
    close_scenery(&s);
}

// --- An environment with a pixel for each of its parts.

static float pixels[ENVIRONMENT_PARTS][3];

static void open_environment(Scenery *s, Environment *environment)
{
    Error error;
    const Image image = {ENVIRONMENT_COLUMNS, ENVIRONMENT_ROWS, 3, (uint8_t *)pixels, IMAGE_FLOAT};
    *environment = (Environment){0};
    assert_int_equal(environment_create(environment, &image, &error), RESULT_OK);
    environment->image = image;
    open_scenery(s, 1, (const double[]){1, 0, 0}, 0.001, COLOR);
    s->scene.environment = environment;
    // Its axes are turned by a quarter about y: its -z is -x of the world.
    s->scene.axes = (EnvironmentAxes){{{0, 0, -1}, {0, 1, 0}, {1, 0, 0}}};
    s->scene.strength = 2;
}

static void close_environment(Scenery *s, Environment *environment)
{
    environment->image = (Image){0}; // `pixels`, which it does not own
    environment_destroy(environment);
    close_scenery(s);
}

// The twin's light of the environment that is in `pixels`: parts x parts directions for each pixel.
static void require_environment(int parts, double allowed)
{
    Scenery s;
    Environment environment;
    open_environment(&s, &environment);
    draw(&s, 8, 300);
    double right[3] = {0};
    for (int i = 0; i < ENVIRONMENT_PARTS; ++i)
        for (int part = 0; part < parts * parts && pixels[i][0] > 0; ++part) {
            double turn = 2 * M_PI *
                          ((i % ENVIRONMENT_COLUMNS + (part % parts + 0.5) / parts) /
                               ENVIRONMENT_COLUMNS -
                           0.5),
                   down = M_PI * (i / ENVIRONMENT_COLUMNS + (part / parts + 0.5) / parts) /
                          ENVIRONMENT_ROWS,
                   own[3] = {sin(down) * sin(turn), cos(down), -sin(down) * cos(turn)};
            const double way[3] = {own[2], own[1], -own[0]};
            for (int c = 0; c < 3; ++c)
                right[c] += 2 * (double)pixels[i][c] * 4 * M_PI *
                            (double)environment.parts[i].share / (parts * parts) *
                            twin_density(0, way[0], atan2(way[1], way[2]), COLOR[c]);
        }
    for (int c = 0; c < 3; ++c)
        if (!(fabs(mean_light(&s, c) / right[c] - 1) < allowed))
            fail_msg("channel %d: %g, expected %g", c, mean_light(&s, c), right[c]);
    close_environment(&s, &environment);
}

// Light of 0.1 to 1. Its standard deviation is at most half of its mean, so 1.5 % are 5 standard
// deviations of the mean of 35,000 paths; the midpoint rule adds a part.
static void an_even_environment_shows_the_twin_s_light(void **state)
{
    (void)state;
    for (int i = 0; i < ENVIRONMENT_PARTS; ++i)
        for (int c = 0; c < 3; ++c)
            pixels[i][c] = 0.55f + 0.45f * cosf(2 * (float)M_PI * (float)(i % ENVIRONMENT_COLUMNS) /
                                                ENVIRONMENT_COLUMNS);
    require_environment(1, 0.015);
}

// One bright pixel in the dark. Nearly all of its light comes from drawn directions, whose light
// has a standard deviation of at most 3 times its mean.
static void a_small_window_shows_the_twin_s_light(void **state)
{
    (void)state;
    memset(pixels, 0, sizeof pixels);
    for (int c = 0; c < 3; ++c) pixels[10 * ENVIRONMENT_COLUMNS + 20][c] = 100;
    require_environment(3, 0.05);
}

static void a_black_environment_gives_no_light(void **state)
{
    (void)state;
    Scenery s;
    memset(pixels, 0, sizeof pixels);
    Environment environment;
    open_environment(&s, &environment);
    draw(&s, 8, 2);
    assert_true(mean_light(&s, 0) == 0);
    close_environment(&s, &environment);
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
        cmocka_unit_test(wide_lights_show_the_twin_s_light),
        cmocka_unit_test(hair_behind_a_lamp_hides_nothing),
        cmocka_unit_test(an_even_environment_shows_the_twin_s_light),
        cmocka_unit_test(a_small_window_shows_the_twin_s_light),
        cmocka_unit_test(a_black_environment_gives_no_light),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
