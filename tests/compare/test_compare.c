// SPDX-License-Identifier: MIT
// Limits, alpha, bit depths, and pairing of images by name or number.
#include "compare/pairs.h"
#include "image/compare.h"
#include "image/float_image.h"
#include "image/pfm.h"
#include "image/png.h"
#include "support/temporary.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

enum { W = 20, H = 10 };

static Image make_image(int channels, const uint8_t color[4])
{
    Image image;
    assert_int_equal(image_create(&image, W, H, channels, NULL), RESULT_OK);
    for (int i = 0; i < W * H * channels; ++i) image.pixels[i] = color[i % channels];
    return image;
}

// Compares and frees.
static CompareResult compare(Image a, Image b, const CompareLimits *limits)
{
    CompareResult result;
    assert_int_equal(compare_images(&result, NULL, &a, &b, NULL, limits, NULL), RESULT_OK);
    image_destroy(&a);
    image_destroy(&b);
    return result;
}

static CompareResult compare_colors(int channels, const uint8_t a[4], const uint8_t b[4])
{
    CompareLimits limits = compare_limits_default();
    limits.figures = COMPARE_SSIM | COMPARE_FLIP;
    return compare(make_image(channels, a), make_image(channels, b), &limits);
}

static void equal_pictures_score_exactly_0(void **state)
{
    (void)state;
    static const uint8_t color[4] = {1, 100, 200, 50};
    for (int channels = 3; channels <= 4; ++channels) {
        CompareResult result = compare_colors(channels, color, color);
        assert_true(result.within && result.failing == 0 && result.largest == 0);
        assert_true(result.rmse == 0 && result.flip == 0 && result.flip_most == 0);
        assert_true(result.ssim == 1 && isinf(result.psnr));
    }
}

// Three pixels are off, by 5, 9 and 20 levels.
static CompareResult compare_three(CompareLimits limits)
{
    static const uint8_t grey[4] = {100, 100, 100};
    Image a = make_image(3, grey), b = make_image(3, grey);
    b.pixels[3 * 7] = 105;
    b.pixels[3 * (W + 3) + 1] = 91;
    b.pixels[3 * (2 * W + 4) + 2] = 120;
    return compare(a, b, &limits);
}

static void the_two_knobs_of_pixels_are_apart(void **state)
{
    (void)state;
    static const struct {
        double tolerance, failing;
        bool percent;
        uint64_t count;
        bool within;
    } cases[] = {
        {0, 0, false, 3, false},   {0, 2, false, 3, false},  {0, 3, false, 3, true},
        {4.5, 2, false, 3, false}, {5, 2, false, 2, true},   {9, 0, false, 1, false},
        {20, 0, false, 0, true},   {0, 1.4, true, 3, false}, {0, 1.5, true, 3, true},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; ++i) {
        CompareLimits limits = compare_limits_default();
        limits.pixel_tolerance = cases[i].tolerance;
        limits.max_failing = cases[i].failing;
        limits.max_failing_percent = cases[i].percent;
        CompareResult result = compare_three(limits);
        assert_int_equal(result.failing, cases[i].count);
        assert_int_equal(result.within, cases[i].within);
        assert_true(result.largest == 20 && result.at[0] == 4 && result.at[1] == 2);
        assert_true(fabs(result.rmse - sqrt((25 + 81 + 400) / (3.0 * W * H))) < 1e-12);
    }
}

static void flip_is_a_limit_of_its_own(void **state)
{
    (void)state;
    CompareLimits limits = compare_limits_default();
    limits.pixels_matter = false;
    limits.flip_matters = true;
    limits.max_flip = 1;
    double flip = compare_three(limits).flip;
    assert_true(flip > 0 && compare_three(limits).within);
    limits.max_flip = flip;
    assert_true(compare_three(limits).within);
    limits.max_flip = 0.99 * flip;
    assert_false(compare_three(limits).within);
    limits.max_flip = 1, limits.pixels_matter = true;
    assert_false(compare_three(limits).within);
}

// A window of 16 x 16 pixels, cut off by the image's height of 10: a block of 2 x 2 pixels, lighter
// by 40 levels, beside one that is darker by 40, whose sum is 0. The window at x = 8 has only the
// first, that at x = 0 both. Blocks lie within a row of cells of 8 pixels.
static void a_local_difference_is_a_mean_with_its_sign(void **state)
{
    (void)state;
    static const uint8_t grey[4] = {100, 100, 100};
    Image a = make_image(3, grey), b = make_image(3, grey);
    for (int y = 2; y < 4; ++y)
        for (int x = 0; x < 2; ++x) {
            b.pixels[3 * (y * W + 9 + x) + 1] = 140;
            b.pixels[3 * (y * W + 4 + x) + 1] = 60;
        }
    CompareLimits limits = compare_limits_default();
    limits.pixels_matter = false;
    limits.local_matters = true;
    CompareResult result = compare(a, b, &limits);
    assert_true(result.local == 4 * 40 / 256.0 && result.local_at[0] == 8);
    assert_int_equal(result.local_at[1], 0);
    assert_false(result.within);
    limits.max_local = result.local;
    assert_true(compare_three(limits).within); // 20 / 256 at most
}

static void a_single_pixel_can_be_too_different(void **state)
{
    (void)state;
    CompareLimits limits = compare_limits_default();
    limits.max_failing = 3;
    limits.difference_matters = true;
    for (int most = 19; most <= 20; ++most) {
        limits.max_difference = most;
        assert_int_equal(compare_three(limits).within, most == 20);
    }
}

// Expected values computed by hand. Black with half alpha is invisible over black; over white it
// differs by 128 levels from black with alpha 0. Colour under alpha 0 is never visible.
static void the_worse_of_two_backgrounds_counts(void **state)
{
    (void)state;
    static const uint8_t none[4] = {0, 0, 0, 0}, half[4] = {0, 0, 0, 128}, red[4] = {255, 0, 0, 0};
    static const uint8_t white_half[4] = {255, 255, 255, 128};
    assert_true(compare_colors(4, none, half).largest == 128);
    assert_true(compare_colors(4, none, white_half).largest == 128);
    assert_true(compare_colors(4, half, none).flip > 0.1);
    // Over the other background both are equal: SSIM 1. Here SSIM of constant areas, whose
    // variances are 0.
    double c1 = 6.5025, over_white = (2 * 255 * 127 + c1) / (255 * 255 + 127 * 127 + c1),
           over_black = c1 / (128 * 128 + c1);
    assert_true(fabs(compare_colors(4, none, half).ssim - over_white) < 1e-6);
    assert_true(fabs(compare_colors(4, none, white_half).ssim - over_black) < 1e-6);
    assert_true(compare_colors(4, none, red).largest == 0 && compare_colors(4, none, red).within);
}

// At each pixel the map has the larger error over the two backgrounds: here over black at one pixel
// and over white at the other.
static void the_map_has_the_worse_of_two_backgrounds(void **state)
{
    (void)state;
    static const uint8_t none[4] = {0, 0, 0, 0};
    Image a = make_image(4, none), b = make_image(4, none);
    enum { OVER_BLACK = 3 * W + 4, OVER_WHITE = 6 * W + 15 };
    memcpy(b.pixels + (size_t)4 * OVER_BLACK, (uint8_t[4]){255, 255, 255, 255}, 4);
    memcpy(b.pixels + (size_t)4 * OVER_WHITE, (uint8_t[4]){0, 0, 0, 255}, 4);
    CompareLimits limits = compare_limits_default();
    CompareResult result;
    float map[W * H];
    assert_int_equal(compare_images(&result, map, &a, &b, NULL, &limits, NULL), RESULT_OK);
    if (!(map[OVER_BLACK] > 0.1f && map[OVER_WHITE] > 0.1f))
        fail_msg("%g, %g", (double)map[OVER_BLACK], (double)map[OVER_WHITE]);
    image_destroy(&a);
    image_destroy(&b);
}

// A share of the compared pixels, not of all.
static void a_share_of_failing_pixels_is_that_of_the_compared_ones(void **state)
{
    (void)state;
    static const uint8_t grey[4] = {100, 100, 100};
    Image a = make_image(3, grey), b = make_image(3, grey);
    bool compared[W * H] = {0};
    Mask mask;
    for (int i = 0; i < 20; ++i) compared[i] = true;
    assert_int_equal(mask_create(&mask, compared, W, H, NULL), RESULT_OK);
    b.pixels[3 * 7] = 200;
    CompareLimits limits = compare_limits_default();
    limits.max_failing_percent = true;
    for (int percent = 4; percent <= 6; ++percent) {
        CompareResult result;
        limits.max_failing = percent;
        assert_int_equal(compare_images(&result, NULL, &a, &b, &mask, &limits, NULL), RESULT_OK);
        assert_int_equal(result.within, percent >= 5); // one pixel of 20
    }
    mask_destroy(&mask);
    image_destroy(&a);
    image_destroy(&b);
}

static void a_picture_without_alpha_is_opaque(void **state)
{
    (void)state;
    static const uint8_t color[4] = {10, 20, 30, 255}, clear[4] = {10, 20, 30, 254};
    CompareLimits limits = compare_limits_default();
    assert_true(compare(make_image(3, color), make_image(4, color), &limits).largest == 0);
    CompareResult result = compare(make_image(3, color), make_image(4, clear), &limits);
    assert_false(result.within);
    // Over white the darkest channel moves by (255 - 10) / 255.
    assert_true(fabs(result.largest - 245.0 / 255) < 1e-5);
}

// --- Files.

static void write_image(const char *path, const Image *image)
{
    Bytes file;
    Result result = image->kind == IMAGE_FLOAT ? pfm_encode(image, &file, NULL)
                                               : png_encode(image, NULL, &file, NULL);
    assert_int_equal(result, RESULT_OK);
    assert_int_equal(bytes_write_file(&file, path, NULL), RESULT_OK);
    bytes_destroy(&file);
}

// A file of each depth. 8 bits can't distinguish the first two values, which are sixteenths of a
// level apart.
static void files_keep_their_depth(void **state)
{
    static const ImageKind kinds[] = {IMAGE_16, IMAGE_FLOAT};
    for (int k = 0; k < 2; ++k) {
        Image image, back;
        const char *path = temporary_path(state, "deep");
        assert_int_equal(image_create_kind(&image, W, H, 3, kinds[k], NULL), RESULT_OK);
        for (int i = 0; i < W * H * 3; ++i) {
            if (kinds[k] == IMAGE_16)
                ((uint16_t *)(void *)image.pixels)[i] = (uint16_t)(i * 109);
            else
                ((float *)(void *)image.pixels)[i] = (float)i / 100 - 1;
        }
        write_image(path, &image);
        assert_int_equal(float_image_read_image(&back, path, NULL), RESULT_OK);
        assert_int_equal(back.kind, kinds[k]);
        assert_memory_equal(back.pixels, image.pixels, image_size(&image));
        image_destroy(&image);
        image_destroy(&back);
    }
}

static void levels_do_not_depend_on_the_depth(void **state)
{
    (void)state;
    uint16_t deep = 200 * 257;
    float linear = (float)image_linear_from_srgb(200 / 255.0), bright = 4;
    uint16_t deeps[3] = {deep, deep, deep};
    float floats[3] = {linear, linear, linear}, brights[3] = {bright, -bright, 0};
    const Image images[] = {
        {1, 1, 3, (uint8_t *)(void *)deeps, IMAGE_16},
        {1, 1, 3, (uint8_t *)(void *)floats, IMAGE_FLOAT},
        {1, 1, 3, (uint8_t *)(void *)brights, IMAGE_FLOAT},
    };
    FloatImage plate;
    for (int i = 0; i < 2; ++i) {
        float_image_create(&plate, &images[i], 0, NULL);
        assert_true(fabs((double)plate.rgb[0] - 200) < 1e-4); // the spacing of floats there is 2e-5
        float_image_destroy(&plate);
    }
    // Values brighter than white are kept.
    float_image_create(&plate, &images[2], 0, NULL);
    assert_true(plate.rgb[0] > 400 && plate.rgb[1] == -plate.rgb[0]);
    float_image_destroy(&plate);
}

static void damaged_floats_are_bad_input(void **state)
{
    static const char *const texts[] = {
        "PF",
        "PF\n1 1\n-1.0\n",
        "PF\n1 1\n-1.0\n0123456789a",
        "PF\n1 1\n-1.0\n0123456789abc",
        "PF\n0 1\n-1.0\n",
        "PF\n1 1\n0\n0123456789ab",
        "PF\n99999 99999\n-1\n",
        "Pf\n1 1\n-1.0\n\xff\xff\xff\xff", // NaN
        "P6\n1 1\n255\nabc",
    };
    for (size_t i = 0; i < sizeof texts / sizeof *texts; ++i) {
        Image image;
        Error error;
        temporary_write(state, "bad.pfm", texts[i], 0644);
        const char *path = temporary_path(state, "bad.pfm");
        assert_int_equal(float_image_read_image(&image, path, &error), RESULT_BAD_INPUT);
        assert_non_null(strstr(error.text, path));
        assert_null(image.pixels);
    }
}

static void grey_floats_of_either_byte_order_are_read(void **state)
{
    static const char *const texts[] = {"Pf\n1 1\n-1.0\nAAA?", "Pf\n1 1\n1.0\n?AAA"};
    for (int i = 0; i < 2; ++i) {
        Image image;
        temporary_write(state, "grey.pfm", texts[i], 0644);
        const char *path = temporary_path(state, "grey.pfm");
        assert_int_equal(float_image_read_image(&image, path, NULL), RESULT_OK);
        for (int k = 0; k < 3; ++k) // 0x3f414141
            assert_true(((float *)(void *)image.pixels)[k] == 0x1.828282p-1F);
        image_destroy(&image);
    }
}

// --- Pairs.

static const PairOptions NO_OPTIONS;

static void check_pairs(void **state, const char *a, const char *b, const char *expected)
{
    PairList list;
    char text[500] = "", from[300], to[300];
    snprintf(from, sizeof from, "%s", temporary_path(state, a));
    snprintf(to, sizeof to, "%s", temporary_path(state, b));
    assert_int_equal(pairs_find(&list, from, to, &NO_OPTIONS, NULL), RESULT_OK);
    for (size_t i = 0; i < list.count; ++i)
        snprintf(text + strlen(text), sizeof text - strlen(text), "%s%s%s ", list.pairs[i].name,
                 list.pairs[i].has_a ? "" : "<", list.pairs[i].has_b ? "" : ">");
    assert_string_equal(text, expected);
    pairs_destroy(&list);
}

static void pictures_go_by_name_or_number(void **state)
{
    static const char *const names[] = {"f_0001.png", "f_0009.png", "f_0010.png",
                                        "f_1.png",    "g7.png",     "g9.png",
                                        "g10.png",    "other.txt",  ".hidden.png"};
    for (size_t i = 0; i < sizeof names / sizeof *names; ++i)
        temporary_write(state, names[i], "", 0644);
    check_pairs(state, "f_%04d.png", "g%d.png", "f_0001.png> g7.png< f_0009.png f_0010.png ");
    check_pairs(state, ".", ".", "f_0001.png f_0009.png f_0010.png f_1.png g7.png g9.png g10.png ");
}

static void two_kinds_of_places_do_not_go_together(void **state)
{
    PairList list;
    Error error;
    const char *folder = temporary_path(state, "."), *file = temporary_path(state, "a.png");
    const char *pattern = temporary_path(state, "x%d.png");
    temporary_write(state, "a.png", "", 0644);
    assert_int_equal(pairs_find(&list, folder, file, &NO_OPTIONS, &error), RESULT_USAGE);
    assert_int_equal(pairs_find(&list, file, pattern, &NO_OPTIONS, &error), RESULT_USAGE);
    assert_int_equal(pairs_find(&list, pattern, pattern, &NO_OPTIONS, &error), RESULT_BAD_INPUT);
    assert_int_equal(pairs_find(&list, temporary_path(state, "no/"), folder, &NO_OPTIONS, &error),
                     RESULT_BAD_INPUT);
}

#define TEST(name) cmocka_unit_test_setup_teardown(name, temporary_create, temporary_destroy)

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(equal_pictures_score_exactly_0),
        cmocka_unit_test(the_two_knobs_of_pixels_are_apart),
        cmocka_unit_test(flip_is_a_limit_of_its_own),
        cmocka_unit_test(a_local_difference_is_a_mean_with_its_sign),
        cmocka_unit_test(a_single_pixel_can_be_too_different),
        cmocka_unit_test(the_worse_of_two_backgrounds_counts),
        cmocka_unit_test(the_map_has_the_worse_of_two_backgrounds),
        cmocka_unit_test(a_share_of_failing_pixels_is_that_of_the_compared_ones),
        cmocka_unit_test(a_picture_without_alpha_is_opaque),
        TEST(files_keep_their_depth),
        cmocka_unit_test(levels_do_not_depend_on_the_depth),
        TEST(damaged_floats_are_bad_input),
        TEST(grey_floats_of_either_byte_order_are_read),
        TEST(pictures_go_by_name_or_number),
        TEST(two_kinds_of_places_do_not_go_together),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
