// SPDX-License-Identifier: MIT
// RMSE, PSNR, SSIM and FLIP against values of an independent computation,
// tests/data/image_figures.py, and in cases with known results.
#include "image/compare.h"
#include "image/flip.h"
#include "image/float_image.h"
#include "image/heat_map.h"
#include "image/ssim.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

enum { W = 37, H = 29 };

// The same formulas as in image_figures.py.
static void color_at(uint8_t c[3], const char *kind, int x, int y)
{
    int n = (x * 7919 + y * 104729 + x * y * 31) % 251;
    bool inside = 2 * x + y < 50;
    const struct {
        const char *kind;
        int color[3];
    } kinds[] = {
        {"ramp", {7 * x % 256, 9 * y % 256, (5 * x + 3 * y) % 256}},
        {"ramp shifted", {7 * (x + 1) % 256, 9 * y % 256, (5 * (x + 1) + 3 * y) % 256}},
        {"edge", {inside ? 200 : 30, inside ? 180 : 60, inside ? 40 : 90}},
        {"edge dimmer", {inside ? 190 : 30, inside ? 170 : 60, inside ? 40 : 90}},
        {"noise", {n, n * 3 % 251, n * 7 % 251}},
        {"grey", {128, 128, 128}},
        {"dot",
         {x == 18 && y == 14 ? 255 : 128, x == 18 && y == 14 ? 255 : 128,
          x == 18 && y == 14 ? 255 : 128}},
        {"blue dot", {128, 128, x == 18 && y == 14 ? 255 : 128}},
        {"black", {0, 0, 0}},
        {"white", {255, 255, 255}},
        {"green", {0, 255, 0}},
        {"blue", {0, 0, 255}},
    };
    for (size_t i = 0; i < sizeof kinds / sizeof *kinds; ++i)
        for (int k = 0; k < 3 && strcmp(kind, kinds[i].kind) == 0; ++k)
            c[k] = (uint8_t)kinds[i].color[k];
}

static Image make_picture(const char *kind)
{
    Image image;
    assert_int_equal(image_create(&image, W, H, 3, NULL), RESULT_OK);
    for (int i = 0; i < W * H; ++i) color_at(image.pixels + 3 * i, kind, i % W, i / W);
    return image;
}

static FloatImage make_plate(const char *kind)
{
    Image image = make_picture(kind);
    FloatImage plate;
    assert_int_equal(float_image_create(&plate, &image, 0, NULL), RESULT_OK);
    image_destroy(&image);
    return plate;
}

// tests/data/image_figures.py prints these three tables.
static const struct {
    const char *a, *b;
    int ppd;
    double rmse, psnr, ssim, flip, flip_most;
} PAIRS[] = {
    {"ramp", "ramp shifted", 67, 26.0885414, 19.8018076, 0.998728784, 0.162951023, 0.896007292},
    {"ramp", "noise", 67, 100.740611, 8.066712, 0.0205529215, 0.803702047, 0.982308478},
    {"edge", "edge dimmer", 67, 5.73300533, 32.9631567, 0.998217883, 0.152672726, 0.286857303},
    {"edge", "ramp", 20, 116.517101, 6.80301019, 0.152674436, 0.948107085, 0.989233547},
    {"grey", "dot", 67, 3.87707194, 36.3607264, 0.917172417, 0.00400748618, 0.378817032},
    {"grey", "dot", 30, 3.87707194, 36.3607264, 0.917172417, 0.00234159338, 0.820974637},
    {"grey", "blue dot", 67, 2.23842853, 41.131939, 0.993960533, 0.00553406777, 0.168902211},
    {"black", "white", 67, 255, 0, 9.9990001e-05, 0.967379762, 0.967379762},
    {"green", "blue", 67, 208.206628, 1.76091259, 0.37447332, 1, 1},
};

static const struct {
    double rgb[3], ycc[3], lab[3];
} COLORS[] = {
    {{1, 1, 1}, {100, 5.55111512e-14, -6.66133815e-14}, {100, 0, 0}},
    {{0, 1, 0}, {66.9612259, -169.470305, 121.143471}, {87.7362107, -75.6099302, 72.9812314}},
    {{0, 0, 1}, {-7.62709721, 58.841021, -160.12035}, {32.29817, 25.578083, -34.836366}},
    {{0.001, 0.002, 0.004},
     {-15.7759201, 0.00705275849, -0.35921758},
     {1.74491875, 0.000958310974, -0.0488095757}},
    {{0.5, 0.3, 0.2}, {22.895884, 16.2417546, 23.807411}, {64.5885252, 7.02284733, 12.2042152}},
};

static const double DIFFERENCES[][2] = {
    {0, 0}, {1, 0.0575393531}, {20, 0.468474517}, {100, 0.967379761}, {203.301655, 1},
};

// Images are stored as floats: rounding an L*a*b* value of up to 100 moves it by up to 4e-6. At a
// HyAB distance of 1, FLIP's slope is 0.04, and less above; below 1, the power 0.7 makes it
// steeper, so that the mean over many such pixels may err by about 1e-7. Changing any constant by a
// hundredth changes the result by more.
#define FLIP_TOLERANCE 1e-6
#define MEAN_TOLERANCE 5e-7

static void figures_are_those_of_an_independent_computation(void **state)
{
    (void)state;
    for (size_t i = 0; i < sizeof PAIRS / sizeof *PAIRS; ++i) {
        Image a = make_picture(PAIRS[i].a), b = make_picture(PAIRS[i].b);
        CompareLimits limits = compare_limits_default();
        limits.figures = COMPARE_SSIM | COMPARE_FLIP;
        CompareResult result;
        limits.pixels_per_degree = PAIRS[i].ppd;
        assert_int_equal(compare_images(&result, NULL, &a, &b, NULL, &limits, NULL), RESULT_OK);
        assert_true(fabs(result.rmse - PAIRS[i].rmse) < 1e-6);
        assert_true(fabs(result.psnr - PAIRS[i].psnr) < 1e-6);
        assert_true(fabs(result.ssim - PAIRS[i].ssim) < 1e-8);
        assert_true(fabs(result.flip - PAIRS[i].flip) < MEAN_TOLERANCE);
        assert_true(fabs(result.flip_most - PAIRS[i].flip_most) < FLIP_TOLERANCE);
        image_destroy(&a);
        image_destroy(&b);
    }
}

static void colors_are_those_of_an_independent_computation(void **state)
{
    (void)state;
    for (size_t i = 0; i < sizeof COLORS / sizeof *COLORS; ++i) {
        double ycc[3], lab[3];
        flip_opponent(ycc, COLORS[i].rgb);
        flip_hunt_lab(lab, COLORS[i].rgb);
        for (int k = 0; k < 3; ++k) {
            assert_true(fabs(ycc[k] - COLORS[i].ycc[k]) < 1e-6);
            assert_true(fabs(lab[k] - COLORS[i].lab[k]) < 1e-6);
        }
    }
}

// By hand: white and black have no chroma, so that HyAB is their difference in L*, 100. Green and
// blue, the most distant colours, differ by 1.
static void differences_of_colors_are_spread_over_0_to_1(void **state)
{
    (void)state;
    const double white[3] = {100, 0, 0}, black[3] = {0, 0, 0}, other[3] = {90, 3, -4};
    assert_true(flip_hyab(white, black) == 100);
    assert_true(fabs(flip_hyab(white, other) - 15) < 1e-12);
    for (size_t i = 0; i < sizeof DIFFERENCES / sizeof *DIFFERENCES; ++i)
        assert_true(fabs(flip_color_difference(DIFFERENCES[i][0]) - DIFFERENCES[i][1]) < 1e-8);
}

// compare_images has a shortcut for equal images; these functions have none.
static void equal_plates_score_exactly_nothing(void **state)
{
    (void)state;
    static const char *const kinds[] = {"ramp", "noise", "edge", "dot", "black", "white", "blue"};
    for (size_t i = 0; i < sizeof kinds / sizeof *kinds; ++i) {
        FloatImage a = make_plate(kinds[i]), b = make_plate(kinds[i]);
        float map[W * H];
        double mean = 1, ssim = 0;
        assert_int_equal(flip_compare(map, &mean, &a, &b, 67, NULL), RESULT_OK);
        assert_int_equal(ssim_compare(&ssim, &a, &b, NULL, NULL), RESULT_OK);
        assert_true(mean == 0 && ssim == 1);
        for (int p = 0; p < W * H; ++p) assert_true(map[p] == 0);
        float_image_destroy(&a);
        float_image_destroy(&b);
    }
}

// By definition, both metrics are symmetric.
static void the_order_of_pictures_does_not_matter(void **state)
{
    (void)state;
    FloatImage a = make_plate("ramp"), b = make_plate("noise");
    float map[W * H];
    double flip[2], ssim[2];
    for (int i = 0; i < 2; ++i) {
        flip_compare(map, &flip[i], i ? &a : &b, i ? &b : &a, 67, NULL);
        ssim_compare(&ssim[i], i ? &a : &b, i ? &b : &a, NULL, NULL);
    }
    assert_true(flip[0] == flip[1] && fabs(ssim[0] - ssim[1]) < 1e-12);
    float_image_destroy(&a);
    float_image_destroy(&b);
}

// The filters and SSIM's window are larger than these images. A single black and a single white
// pixel have the SSIM of black and white areas, C1 / (255^2 + C1), and also the FLIP of areas.
static void a_single_pixel_can_be_compared(void **state)
{
    (void)state;
    static const int ppds[] = {1, 67, 1000};
    for (int i = 0; i < 3; ++i) {
        float white[3] = {255, 255, 255}, black[3] = {0}, map;
        FloatImage a = {1, 1, white}, b = {1, 1, black};
        double flip, ssim;
        assert_int_equal(flip_compare(&map, &flip, &a, &b, ppds[i], NULL), RESULT_OK);
        assert_int_equal(ssim_compare(&ssim, &a, &b, NULL, NULL), RESULT_OK);
        assert_true(fabs(flip - 0.967379762) < FLIP_TOLERANCE);
        assert_true(fabs(ssim - 6.5025 / (65025 + 6.5025)) < 1e-12);
    }
}

// Windows shrink to the largest odd square that fits. For any size, black and white have the SSIM
// of areas, and equal images have 1.
static void pictures_of_every_small_size_can_be_compared(void **state)
{
    (void)state;
    enum { MOST = 13 };
    static float white[3 * MOST * MOST], black[3 * MOST * MOST];
    for (int i = 0; i < 3 * MOST * MOST; ++i) white[i] = 255;
    for (int width = 1; width <= MOST; ++width)
        for (int height = 1; height <= MOST; ++height) {
            FloatImage a = {width, height, white}, b = {width, height, black};
            double ssim;
            assert_int_equal(ssim_compare(&ssim, &a, &b, NULL, NULL), RESULT_OK);
            assert_true(fabs(ssim - 6.5025 / (65025 + 6.5025)) < 1e-12);
            assert_int_equal(ssim_compare(&ssim, &a, &a, NULL, NULL), RESULT_OK);
            assert_true(fabs(ssim - 1) < 1e-12);
        }
}

// A single dot is invisible from far away and visible from nearby: FLIP depends on the viewing
// distance.
static void what_is_seen_depends_on_the_distance(void **state)
{
    (void)state;
    FloatImage a = make_plate("grey"), b = make_plate("dot");
    float map[W * H];
    double mean, near, far;
    flip_compare(map, &mean, &a, &b, 20, NULL);
    near = (double)map[14 * W + 18];
    flip_compare(map, &mean, &a, &b, 200, NULL);
    far = (double)map[14 * W + 18];
    assert_true(near > 0.8 && far < 0.2);
    float_image_destroy(&a);
    float_image_destroy(&b);
}

static double lightness(const uint8_t rgb[3])
{
    double y = 0, factors[3] = {0.2126, 0.7152, 0.0722};
    for (int k = 0; k < 3; ++k) y += factors[k] * float_image_linear(rgb[k]);
    return y > 216.0 / 24389 ? 116 * cbrt(y) - 16 : 24389.0 / 27 * y;
}

static void a_rounded_map_has_few_steps_and_hides_nothing(void **state)
{
    (void)state;
    float errors[] = {0, 1e-6f, 0.5f, 0.505f, 1, 2, NAN};
    heat_map_round(errors, sizeof errors / sizeof *errors);
    const float step = 1.0f / (HEAT_MAP_STEPS - 1);
    assert_true(errors[0] == 0 && errors[1] == step && errors[4] == 1 && errors[5] == 1);
    assert_true(fabsf(errors[2] - 0.5f) <= step / 2 + 1e-6f && errors[2] == errors[3]);
    assert_true(isnan(errors[6]));
}

static void a_larger_error_is_lighter_in_the_heat_map(void **state)
{
    (void)state;
    uint8_t rgb[3];
    double before = -1;
    for (int i = 0; i <= 100; ++i) {
        heat_map_color(rgb, (float)i / 100);
        assert_true(lightness(rgb) >= before);
        assert_true(fabs(lightness(rgb) - 0.98 * i) < 5);
        before = lightness(rgb);
    }
}

static void a_heat_map_has_the_colour_of_each_error(void **state)
{
    static float errors[W * H];
    Image map;
    (void)state;
    for (int i = 0; i < W * H; ++i) errors[i] = i % 5 == 4 ? NAN : (float)i / (W * H);
    assert_int_equal(heat_map_create(&map, errors, W, H, NULL), RESULT_OK);
    assert_int_equal(map.width, W);
    assert_int_equal(map.height, H);
    assert_int_equal(map.channels, 3);
    assert_int_equal(map.kind, IMAGE_8);
    for (int i = 0; i < W * H; ++i) {
        const uint8_t *pixel = map.pixels + 3 * i;
        uint8_t rgb[3] = {pixel[0], pixel[0], pixel[0]}; // an ignored pixel is grey
        if (!isnan(errors[i])) heat_map_color(rgb, errors[i]);
        assert_memory_equal(pixel, rgb, 3);
    }
    image_destroy(&map);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(figures_are_those_of_an_independent_computation),
        cmocka_unit_test(colors_are_those_of_an_independent_computation),
        cmocka_unit_test(differences_of_colors_are_spread_over_0_to_1),
        cmocka_unit_test(equal_plates_score_exactly_nothing),
        cmocka_unit_test(the_order_of_pictures_does_not_matter),
        cmocka_unit_test(a_single_pixel_can_be_compared),
        cmocka_unit_test(pictures_of_every_small_size_can_be_compared),
        cmocka_unit_test(what_is_seen_depends_on_the_distance),
        cmocka_unit_test(a_larger_error_is_lighter_in_the_heat_map),
        cmocka_unit_test(a_heat_map_has_the_colour_of_each_error),
        cmocka_unit_test(a_rounded_map_has_few_steps_and_hides_nothing),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
