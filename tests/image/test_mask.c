// SPDX-License-Identifier: MIT
// Masks: ignored pixels have no influence on any metric; all compared pixels have.
#include "image/compare.h"
#include "image/mask.h"
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

enum { W = 40, H = 30, PIXELS = W * H };

// Pseudo-random numbers from a seed, by Knuth's multiplier for 64 bits.
static unsigned noise(uint64_t seed, uint64_t i)
{
    uint64_t x = (seed + 1) * 6364136223846793005U + i * 1442695040888963407U;
    x ^= x >> 33;
    x *= 6364136223846793005U;
    return (unsigned)(x >> 40);
}

static Image make_noise(int width, int height, int channels, uint64_t seed)
{
    Image image;
    assert_int_equal(image_create(&image, width, height, channels, NULL), RESULT_OK);
    for (size_t i = 0; i < image_size(&image); ++i)
        image.pixels[i] = (uint8_t)(noise(seed, i) & 255);
    return image;
}

typedef enum Shape { BLOCK, LEFT, SPECKS, ONE } Shape;

static bool is_compared(Shape shape, int i)
{
    int x = i % W, y = i / W;
    return shape == BLOCK    ? x < 10 || x >= 22 || y < 8 || y >= 20
           : shape == LEFT   ? x < W / 2
           : shape == SPECKS ? noise(9, (uint64_t)i) % 3 == 0
                             : x == 3 && y == 28;
}

static Mask make_mask(Shape shape)
{
    bool compared[PIXELS];
    Mask mask;
    for (int i = 0; i < PIXELS; ++i) compared[i] = is_compared(shape, i);
    assert_int_equal(mask_create(&mask, compared, W, H, NULL), RESULT_OK);
    return mask;
}

static CompareResult compare(float *map, const Image *a, const Image *b, const Mask *mask)
{
    CompareLimits limits = compare_limits_default();
    limits.figures = COMPARE_SSIM | COMPARE_FLIP;
    CompareResult result;
    assert_int_equal(compare_images(&result, map, a, b, mask, &limits, NULL), RESULT_OK);
    return result;
}

static void assert_same_figures(const CompareResult *p, const CompareResult *q)
{
    assert_true(p->compared == q->compared && p->failing == q->failing);
    assert_true(p->largest == q->largest && p->at[0] == q->at[0] && p->at[1] == q->at[1]);
    assert_true(p->rmse == q->rmse && p->psnr == q->psnr && p->ssim == q->ssim);
    assert_true(p->flip == q->flip && p->flip_most == q->flip_most && p->within == q->within);
}

static int square(int a)
{
    return a * a;
}

static void the_nearest_compared_pixel_is_the_nearest(void **state)
{
    (void)state;
    for (Shape shape = BLOCK; shape <= ONE; ++shape) {
        Mask mask = make_mask(shape);
        for (int i = 0; i < PIXELS; ++i) {
            int least = 1 << 20, to = mask.nearest[i];
            for (int j = 0; j < PIXELS; ++j) {
                int distance = square(i % W - j % W) + square(i / W - j / W);
                if (is_compared(shape, j) && distance < least) least = distance;
            }
            assert_true(is_compared(shape, to));
            assert_int_equal(square(i % W - to % W) + square(i / W - to / W), least);
            assert_int_equal(mask_counts(&mask, (size_t)i), is_compared(shape, i));
        }
        mask_destroy(&mask);
    }
}

// With and without alpha; exactly equal, since ignored pixels must have no influence at all.
static void what_is_ignored_changes_no_figure(void **state)
{
    (void)state;
    for (Shape shape = BLOCK; shape <= ONE; ++shape)
        for (int channels = 3; channels <= 4; ++channels) {
            Image a = make_noise(W, H, channels, 1), b = make_noise(W, H, channels, 2);
            Image other = make_noise(W, H, channels, 3), fourth = make_noise(W, H, channels, 4);
            Mask mask = make_mask(shape);
            float maps[2][PIXELS];
            CompareResult before = compare(maps[0], &a, &b, &mask);
            for (size_t i = 0; i < image_size(&a); ++i) {
                if (is_compared(shape, (int)i / channels)) continue;
                a.pixels[i] = other.pixels[i], b.pixels[i] = fourth.pixels[i];
            }
            CompareResult after = compare(maps[1], &a, &b, &mask);
            assert_same_figures(&before, &after);
            for (int i = 0; i < PIXELS; ++i) {
                assert_int_equal(isnan(maps[0][i]), !is_compared(shape, i));
                if (is_compared(shape, i)) assert_true(maps[0][i] == maps[1][i]);
            }
            mask_destroy(&mask);
            Image *images[] = {&a, &b, &other, &fourth};
            for (int i = 0; i < 4; ++i) image_destroy(images[i]);
        }
}

// Images that agree in all compared pixels. The shortcut for equal images does not apply.
static void differences_that_are_ignored_score_exactly_0(void **state)
{
    (void)state;
    for (Shape shape = BLOCK; shape <= ONE; ++shape) {
        Image a = make_noise(W, H, 3, 1), b = make_noise(W, H, 3, 2);
        Mask mask = make_mask(shape);
        for (size_t i = 0; i < image_size(&a); ++i)
            if (is_compared(shape, (int)i / 3)) b.pixels[i] = a.pixels[i];
        CompareResult result = compare(NULL, &a, &b, &mask);
        assert_true(result.within && result.failing == 0 && result.largest == 0);
        assert_true(result.rmse == 0 && result.flip == 0 && result.flip_most == 0);
        assert_true(result.ssim == 1 && isinf(result.psnr));
        assert_false(compare(NULL, &a, &b, NULL).within);
        // One compared pixel that differs by one level suffices.
        size_t last = 0;
        for (size_t i = 0; i < PIXELS; ++i)
            if (is_compared(shape, (int)i)) last = i;
        b.pixels[3 * last] ^= 1;
        assert_false(compare(NULL, &a, &b, &mask).within);
        mask_destroy(&mask);
        image_destroy(&a);
        image_destroy(&b);
    }
}

static void a_white_mask_is_no_mask(void **state)
{
    (void)state;
    bool compared[PIXELS];
    Mask mask;
    memset(compared, true, sizeof compared);
    assert_int_equal(mask_create(&mask, compared, W, H, NULL), RESULT_OK);
    Image a = make_noise(W, H, 4, 1), b = make_noise(W, H, 4, 2);
    CompareResult with = compare(NULL, &a, &b, &mask), without = compare(NULL, &a, &b, NULL);
    assert_same_figures(&with, &without);
    mask_destroy(&mask);
    image_destroy(&a);
    image_destroy(&b);
}

static Image crop_left(const Image *image)
{
    Image left;
    assert_int_equal(image_create(&left, W / 2, H, 3, NULL), RESULT_OK);
    for (int y = 0; y < H; ++y)
        memcpy(left.pixels + (size_t)(3 * y * (W / 2)), image->pixels + (size_t)(3 * y * W),
               3 * (W / 2));
    return left;
}

// Masking a half equals cutting it off: in both cases, the nearest pixel continues the image.
// SSIM's windows are the exception: they stay within the image.
static void a_masked_half_is_as_good_as_cut_off(void **state)
{
    (void)state;
    Image a = make_noise(W, H, 3, 1), b = make_noise(W, H, 3, 2);
    Image left_a = crop_left(&a), left_b = crop_left(&b);
    Mask mask = make_mask(LEFT);
    float map[PIXELS], left_map[PIXELS / 2];
    CompareResult masked = compare(map, &a, &b, &mask);
    CompareResult cut = compare(left_map, &left_a, &left_b, NULL);
    assert_true(masked.compared == cut.compared && masked.failing == cut.failing);
    assert_true(masked.rmse == cut.rmse && masked.largest == cut.largest);
    assert_true(masked.flip == cut.flip && masked.flip_most == cut.flip_most);
    for (int i = 0; i < PIXELS; ++i)
        if (i % W < W / 2) assert_true(map[i] == left_map[i / W * (W / 2) + i % W]);
    mask_destroy(&mask);
    Image *images[] = {&a, &b, &left_a, &left_b};
    for (int i = 0; i < 4; ++i) image_destroy(images[i]);
}

static double luma_of(const Image *image, int i)
{
    const uint8_t *rgb = image->pixels + 3 * i;
    return 0.299 * rgb[0] + 0.587 * rgb[1] + 0.114 * rgb[2];
}

// Independent computation: central moments of a window, pixel by pixel, from the definition.
static void find_index(double *index, double *share, const Image *a, const Image *b, Shape shape,
                       int x, int y)
{
    double weight = 0, whole = 0, mean[2] = {0}, aa = 0, bb = 0, ab = 0;
    for (int pass = 0; pass < 2; ++pass)
        for (int j = -5; j <= 5; ++j)
            for (int i = -5; i <= 5; ++i) {
                int pixel = (y + j) * W + x + i;
                double w = exp(-(i * i + j * j) / (2 * 1.5 * 1.5));
                if (pass == 0) whole += w;
                if (!is_compared(shape, pixel)) continue;
                double p = luma_of(a, pixel), q = luma_of(b, pixel);
                if (pass == 0) {
                    weight += w, mean[0] += w * p, mean[1] += w * q;
                    continue;
                }
                p -= mean[0] / weight, q -= mean[1] / weight;
                aa += w * p * p, bb += w * q * q, ab += w * p * q;
            }
    *share = weight / whole;
    if (weight == 0) return;
    double p = mean[0] / weight, q = mean[1] / weight, c1 = 6.5025, c2 = 58.5225;
    *index = (2 * p * q + c1) * (2 * ab / weight + c2) /
             ((p * p + q * q + c1) * (aa / weight + bb / weight + c2));
}

static void similarity_is_over_compared_pixels(void **state)
{
    (void)state;
    for (Shape shape = BLOCK; shape <= ONE; ++shape) {
        Image a = make_noise(W, H, 3, 1), b = make_noise(W, H, 3, 2);
        Mask mask = make_mask(shape);
        double sum = 0, shares = 0;
        for (int y = 5; y < H - 5; ++y)
            for (int x = 5; x < W - 5; ++x) {
                double index = 0, share;
                find_index(&index, &share, &a, &b, shape, x, y);
                sum += share * index, shares += share;
            }
        // Variances are up to 1e4 and are differences of numbers of 6e4, with errors of 1e-11.
        assert_true(fabs(compare(NULL, &a, &b, &mask).ssim - sum / shares) < 1e-10);
        mask_destroy(&mask);
        image_destroy(&a);
        image_destroy(&b);
    }
}

// 144 of 1200 pixels are ignored: 1 % of the other 1056 is 10.56.
static void percentages_are_of_compared_pixels(void **state)
{
    (void)state;
    Image a = make_noise(W, H, 3, 1), b = make_noise(W, H, 3, 1);
    Mask mask = make_mask(BLOCK);
    CompareLimits limits = compare_limits_default();
    limits.figures = COMPARE_SSIM | COMPARE_FLIP;
    limits.max_failing = 1, limits.max_failing_percent = true;
    for (int failing = 1; failing <= 12; ++failing) {
        CompareResult result;
        b.pixels[3 * failing] ^= 255;
        compare_images(&result, NULL, &a, &b, &mask, &limits, NULL);
        assert_int_equal(result.compared, 1056);
        assert_int_equal(result.failing, failing);
        assert_int_equal(result.within, failing <= 10);
    }
    mask_destroy(&mask);
    image_destroy(&a);
    image_destroy(&b);
}

// --- Files.

static void write_pixels(void **state, const char *name, int channels, const uint8_t *pixels)
{
    Image image = {2, 2, channels, NULL, IMAGE_8};
    uint8_t copy[16];
    memcpy(copy, pixels, (size_t)(4 * channels));
    image.pixels = copy;
    assert_int_equal(png_write(temporary_path(state, name), &image, NULL), RESULT_OK);
}

static void white_is_compared_and_black_ignored(void **state)
{
    static const uint8_t greys[12] = {0, 0, 0, 127, 127, 127, 128, 128, 128, 255, 255, 255};
    static const uint8_t clear[16] = {0, 0, 0, 255, 0, 0, 0, 127, 0, 0, 0, 128, 0, 0, 0, 0};
    static const bool expected[2][4] = {{false, false, true, true}, {false, true, false, true}};
    write_pixels(state, "greys.png", 3, greys);
    write_pixels(state, "clear.png", 4, clear);
    for (int k = 0; k < 2; ++k) {
        Mask mask;
        const char *path = temporary_path(state, k ? "clear.png" : "greys.png");
        assert_int_equal(mask_read(&mask, path, NULL), RESULT_OK);
        assert_int_equal(mask.width, 2);
        assert_int_equal(mask.count, 2);
        for (size_t i = 0; i < 4; ++i) assert_int_equal(mask_counts(&mask, i), expected[k][i]);
        mask_destroy(&mask);
    }
}

static void a_mask_that_ignores_all_is_refused(void **state)
{
    static const uint8_t black[12] = {0};
    Mask mask;
    Error error;
    write_pixels(state, "black.png", 3, black);
    temporary_write(state, "text.png", "no image", 0644);
    static const char *const names[] = {"black.png", "text.png", "missing.png"};
    for (int i = 0; i < 3; ++i) {
        const char *path = temporary_path(state, names[i]);
        assert_int_equal(mask_read(&mask, path, &error), RESULT_BAD_INPUT);
        assert_non_null(strstr(error.text, path));
        assert_null(mask.nearest);
    }
}

#define TEST(name) cmocka_unit_test_setup_teardown(name, temporary_create, temporary_destroy)

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_nearest_compared_pixel_is_the_nearest),
        cmocka_unit_test(what_is_ignored_changes_no_figure),
        cmocka_unit_test(differences_that_are_ignored_score_exactly_0),
        cmocka_unit_test(a_white_mask_is_no_mask),
        cmocka_unit_test(a_masked_half_is_as_good_as_cut_off),
        cmocka_unit_test(similarity_is_over_compared_pixels),
        cmocka_unit_test(percentages_are_of_compared_pixels),
        TEST(white_is_compared_and_black_ignored),
        TEST(a_mask_that_ignores_all_is_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
