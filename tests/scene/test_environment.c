// SPDX-License-Identifier: MIT
// Environment light from an equirectangular image: the directions of its pixels, and the light on
// surfaces and in directions of the light grid.
#include "scene/environment.h"

#include "base/random.h"
#include "support/needed.h"
#include "support/temporary.h"

#include "glsl/kernel/lamp.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdio.h>
#include <string.h>

#include <cmocka.h>

enum { HEIGHT = 16, WIDTH = 2 * HEIGHT, WAYS = 48 };

static const EnvironmentAxes LEVEL = {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
static float pixels[HEIGHT][WIDTH][3];

static void fill(float light)
{
    for (int i = 0; i < 3 * WIDTH * HEIGHT; ++i) ((float *)pixels)[i] = light;
}

static Environment make(void)
{
    const Image image = {WIDTH, HEIGHT, 3, (uint8_t *)pixels, IMAGE_FLOAT};
    Environment environment = {0};
    NEEDED(environment_create(&environment, &image, error));
    return environment;
}

// Directions that are spread evenly by a Fibonacci spiral.
static void find_ways(float way[WAYS][3])
{
    for (int i = 0; i < WAYS; ++i) {
        double y = 1 - 2 * (i + 0.5) / WAYS, wide = sqrt(1 - y * y), turn = 2.399963 * i;
        way[i][0] = (float)(wide * cos(turn)), way[i][1] = (float)y;
        way[i][2] = (float)(wide * sin(turn));
    }
}

// Evaluates the polynomial like the renderer.
static double shown(float terms[ENVIRONMENT_TERMS][3], int c, const float n[3])
{
    float even = lamp_around(terms[0][c] + terms[1][c], terms[0][c] - terms[1][c], n[1]);
    return (double)(even + lamp_aside(terms[2][c], terms[3][c], n[0], n[2]) +
                    lamp_bent(terms[4][c], terms[5][c], terms[6][c], terms[7][c], terms[8][c], n[0],
                              n[1], n[2]));
}

// Integral over the hemisphere, divided by pi.
static double exact(const Environment *environment, int c, const float n[3])
{
    double sum = 0;
    for (int i = 0; i < ENVIRONMENT_PARTS; ++i) {
        const EnvironmentPart *part = &environment->parts[i];
        float cosine = part->way[0] * n[0] + part->way[1] * n[1] + part->way[2] * n[2];
        sum += 4 * (double)part->share * fmax((double)cosine, 0) * (double)part->light[c];
    }
    return sum;
}

// --- Tests.

static void the_image_lies_as_one_sees_it(void **state)
{
    (void)state;
    static const struct {
        int x, y;
        float way[3];
    } places[] = {{WIDTH / 2, HEIGHT / 2, {0, 0, -1}},
                  {3 * WIDTH / 4, HEIGHT / 2, {1, 0, 0}},
                  {WIDTH / 4, HEIGHT / 2, {-1, 0, 0}},
                  {0, HEIGHT / 2, {0, 0, 1}},
                  {3, 0, {0, 1, 0}},
                  {3, HEIGHT - 1, {0, -1, 0}}};
    for (size_t i = 0; i < sizeof places / sizeof *places; ++i) {
        fill(0);
        pixels[places[i].y][places[i].x][1] = 5;
        Environment environment = make();
        double sum[3] = {0}, light = 0;
        for (int p = 0; p < ENVIRONMENT_PARTS; ++p)
            for (int k = 0; k < 3; ++k) {
                double part = (double)(environment.parts[p].share * environment.parts[p].light[1]);
                sum[k] += part * (double)environment.parts[p].way[k];
                light += part / 3;
            }
        // The spot is 11 degrees wide; its middle is off by half of that on each axis, and its
        // light is spread over it.
        double cosine = 0;
        for (int k = 0; k < 3; ++k) cosine += sum[k] / light * (double)places[i].way[k];
        assert_true(cosine > cos(0.17));
        environment_destroy(&environment);
    }
}

static void an_even_one_is_as_bright_on_all_sides(void **state)
{
    (void)state;
    float terms[ENVIRONMENT_TERMS][3], way[WAYS][3], light[WAYS][3];
    find_ways(way);
    fill(0.7f);
    Environment environment = make();
    environment_around(&environment, &LEVEL, terms);
    environment_spread(&environment, &LEVEL, (const float(*)[3])way, WAYS, light);
    for (int t = 0; t < ENVIRONMENT_TERMS; ++t)
        for (int c = 0; c < 3; ++c) assert_true(fabsf(terms[t][c] - (t ? 0 : 0.7f)) < 1e-6f);
    for (int d = 0; d < WAYS; ++d)
        for (int c = 0; c < 3; ++c) assert_true(fabsf(light[d][c] - 0.7f) < 1e-5f);
    environment_destroy(&environment);
}

// For light from one direction at cosine c, the polynomial is (1 + 2 c + 5/8 (3 c^2 - 1)) times the
// mean, where Lambert's law has 4 c (Ramamoorthi and Hanrahan 2001).
static void a_spot_shows_as_its_polynomial(void **state)
{
    (void)state;
    const EnvironmentAxes turned = {{{0.8f, 0, -0.6f}, {0, 1, 0}, {0.6f, 0, 0.8f}}};
    float terms[ENVIRONMENT_TERMS][3], way[WAYS][3];
    find_ways(way);
    fill(0);
    pixels[5][20][2] = 100;
    Environment environment = make();
    environment_around(&environment, &turned, terms);
    double mean = 0, to[3] = {0}, length = 0;
    for (int p = 0; p < ENVIRONMENT_PARTS; ++p) {
        const EnvironmentPart *part = &environment.parts[p];
        double light = (double)(part->share * part->light[2]);
        mean += light;
        for (int k = 0; k < 3; ++k)
            for (int n = 0; n < 3; ++n) to[n] += light * (double)(part->way[k] * turned.axis[k][n]);
    }
    for (int k = 0; k < 3; ++k) length += to[k] * to[k];
    assert_true(mean > 0.1);
    for (int d = 0; d < WAYS; ++d) {
        double c = 0;
        for (int k = 0; k < 3; ++k) c += to[k] / sqrt(length) * (double)way[d][k];
        double expected = mean * (1 + 2 * c + 0.625 * (3 * c * c - 1));
        // The spot is 11 degrees wide, which changes the mean square by a hundredth.
        assert_true(fabs(shown(terms, 2, way[d]) - expected) < 0.02 * mean);
        assert_true(fabs(shown(terms, 0, way[d])) < 1e-9);
    }
    environment_destroy(&environment);
}

// In typical light, soft boxes in a room, the polynomial errs by less than 5 % of the brightest
// side.
static void surfaces_show_nearly_the_exact_light(void **state)
{
    (void)state;
    float terms[ENVIRONMENT_TERMS][3], way[WAYS][3];
    Environment environment;
    double most = 0, off = 0;
    find_ways(way);
    NEEDED(environment_read(&environment, "assets/studio.pfm", false, error));
    environment_around(&environment, &LEVEL, terms);
    for (int d = 0; d < WAYS; ++d) {
        double right = exact(&environment, 0, way[d]);
        most = fmax(most, right);
        off = fmax(off, fabs(shown(terms, 0, way[d]) - right));
    }
    print_message("off by %.3f of %.3f at most\n", off, most);
    assert_true(off < 0.04 * most);
    environment_destroy(&environment);
}

static void directions_keep_all_light(void **state)
{
    (void)state;
    float way[WAYS][3], light[WAYS][3];
    Random random = random_create(4, 1);
    find_ways(way);
    for (int i = 0; i < 3 * WIDTH * HEIGHT; ++i)
        ((float *)pixels)[i] = (float)random_below(&random, 1000) * 1e-3f;
    pixels[9][7][0] = 300; // a sun, much brighter than the rest
    pixels[1][1][1] = -50; // negative: not light
    Environment environment = make();
    environment_spread(&environment, &LEVEL, (const float(*)[3])way, WAYS, light);
    for (int c = 0; c < 3; ++c) {
        double all = 0, spread = 0;
        for (int p = 0; p < ENVIRONMENT_PARTS; ++p)
            all += (double)(environment.parts[p].share * environment.parts[p].light[c]);
        for (int d = 0; d < WAYS; ++d) {
            assert_true(light[d][c] >= 0);
            spread += (double)light[d][c] / WAYS;
        }
        assert_true(fabs(spread / all - 1) < 1e-5);
    }
    int brightest = 0;
    for (int d = 0; d < WAYS; ++d) brightest = light[d][0] > light[brightest][0] ? d : brightest;
    double turn = 2 * M_PI * (7.5 / WIDTH - 0.5), down = M_PI * 9.5 / HEIGHT,
           cosine = sin(down) * sin(turn) * (double)way[brightest][0] +
                    cos(down) * (double)way[brightest][1] -
                    sin(down) * cos(turn) * (double)way[brightest][2];
    assert_true(cosine > 0.93);
    environment_destroy(&environment);
}

// Turning the environment equals shifting the image.
static void a_turn_shifts_the_image(void **state)
{
    (void)state;
    const EnvironmentAxes quarter = {{{0, 0, -1}, {0, 1, 0}, {1, 0, 0}}}; // about y
    static float before[HEIGHT][WIDTH][3];
    float way[WAYS][3], turned[WAYS][3], shifted[WAYS][3], terms[2][ENVIRONMENT_TERMS][3];
    Random random = random_create(8, 1);
    find_ways(way);
    for (int i = 0; i < 3 * WIDTH * HEIGHT; ++i)
        ((float *)before)[i] = (float)random_below(&random, 1000) * 1e-3f;
    memcpy(pixels, before, sizeof pixels);
    Environment environment = make();
    environment_spread(&environment, &quarter, (const float(*)[3])way, WAYS, turned);
    environment_around(&environment, &quarter, terms[0]);
    environment_destroy(&environment);
    for (int y = 0; y < HEIGHT; ++y)
        for (int x = 0; x < WIDTH; ++x)
            memcpy(pixels[y][(x + 3 * WIDTH / 4) % WIDTH], before[y][x], sizeof before[y][x]);
    environment = make();
    environment_spread(&environment, &LEVEL, (const float(*)[3])way, WAYS, shifted);
    environment_around(&environment, &LEVEL, terms[1]);
    environment_destroy(&environment);
    for (int d = 0; d < WAYS; ++d)
        for (int c = 0; c < 3; ++c) assert_true(fabsf(turned[d][c] - shifted[d][c]) < 1e-4f);
    for (int t = 0; t < ENVIRONMENT_TERMS; ++t)
        for (int c = 0; c < 3; ++c) assert_true(fabsf(terms[0][t][c] - terms[1][t][c]) < 1e-4f);
}

static void other_files_are_refused(void **state)
{
    const char *square = temporary_path(state, "square.pfm");
    FILE *file = fopen(square, "wb");
    assert_non_null(file);
    fputs("PF\n1 1\n-1.0\n123412341234", file);
    assert_int_equal(fclose(file), 0);
    const struct {
        const char *path, *says;
    } files[] = {{square, "1 x 1 px"},
                 {"docs/fur.png", ".exr, .hdr or .pfm"},
                 {"assets/none.exr", "assets/none.exr"},
                 {"assets/demo.json", "assets/demo.json"}};
    for (size_t i = 0; i < sizeof files / sizeof *files; ++i) {
        Environment environment;
        Error error = {{0}};
        assert_int_equal(environment_read(&environment, files[i].path, false, &error),
                         RESULT_BAD_INPUT);
        if (!strstr(error.text, files[i].says)) fail_msg("%s", error.text);
        environment_destroy(&environment);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_image_lies_as_one_sees_it),
        cmocka_unit_test(an_even_one_is_as_bright_on_all_sides),
        cmocka_unit_test(a_spot_shows_as_its_polynomial),
        cmocka_unit_test(surfaces_show_nearly_the_exact_light),
        cmocka_unit_test(directions_keep_all_light),
        cmocka_unit_test(a_turn_shifts_the_image),
        cmocka_unit_test_setup_teardown(other_files_are_refused, temporary_create,
                                        temporary_destroy),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
