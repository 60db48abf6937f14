// SPDX-License-Identifier: MIT
#include "image/meter.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdlib.h>

#include <cmocka.h>

enum { SIDE = 20 };

typedef struct Tile {
    int count;             // of pixels
    float light, coverage; // grey, not premultiplied
} Tile;

// What the meter says of tiles that fill an image together.
static double meter(const Tile *tiles, int count)
{
    Image image;
    float exposure = NAN, *pixel;
    int left = SIDE * SIDE;
    assert_int_equal(image_create_kind(&image, SIDE, SIDE, 4, IMAGE_FLOAT, NULL), RESULT_OK);
    pixel = (float *)(void *)image.pixels;
    for (int i = 0; i < count; ++i)
        for (int k = 0; k < tiles[i].count && left > 0; ++k, --left, pixel += 4) {
            for (int c = 0; c < 3; ++c) pixel[c] = tiles[i].light * tiles[i].coverage;
            pixel[3] = tiles[i].coverage;
        }
    assert_int_equal(left, 0);
    assert_int_equal(meter_exposure(&exposure, &image, NULL), RESULT_OK);
    image_destroy(&image);
    return (double)exposure;
}

static double meter_all(double light)
{
    return meter(&(Tile){SIDE * SIDE, (float)light, 1}, 1);
}

static void an_even_grey_comes_to_the_middle_in_part(void **state)
{
    (void)state;
    assert_true(fabs(meter_all(METER_MIDDLE)) <= METER_STEP / 2);
    for (int stops = -8; stops <= 3; ++stops) {
        double expected = -stops * (1 - METER_KEPT);
        assert_true(fabs(meter_all(METER_MIDDLE * exp2(stops)) - expected) <= METER_STEP / 2);
    }
}

static void the_result_is_a_whole_number_of_steps(void **state)
{
    (void)state;
    for (int i = 1; i < 50; ++i) {
        double steps = meter_all(0.007 * i) / METER_STEP;
        assert_true(steps == round(steps));
    }
}

static void what_is_not_covered_does_not_count(void **state)
{
    (void)state;
    const Tile tiles[] = {{100, 0.02f, 1}, {200, 9, 0.49f}, {100, 5, 0}};
    assert_true(meter(tiles, 3) == meter_all(0.02));
    const Tile half[] = {{200, 0.02f, 0.51f}, {200, 9, 0}};
    assert_true(meter(half, 2) == meter_all(0.02));
}

static void nothing_and_black_have_no_exposure(void **state)
{
    (void)state;
    assert_true(meter(&(Tile){SIDE * SIDE, 1, 0}, 1) == 0);
    assert_true(meter_all(0) == 0);
}

// 4 % of the pixels are 50 times as bright as the rest.
static void highlights_stay_below_white(void **state)
{
    (void)state;
    const Tile tiles[] = {{384, 0.01f, 1}, {16, 0.5f, 1}};
    assert_true(fabs(meter(tiles, 2) - log2(METER_WHITE / 0.5)) <= METER_STEP / 2);
}

// A few of them do not matter, and neither do a few that are black.
static void single_pixels_do_not_matter(void **state)
{
    (void)state;
    const Tile bright[] = {{398, 0.02f, 1}, {2, 1000, 1}}, dark[] = {{398, 0.02f, 1}, {2, 0, 1}};
    assert_true(fabs(meter(bright, 2) - meter_all(0.02)) <= 2 * METER_STEP);
    assert_true(fabs(meter(dark, 2) - meter_all(0.02)) <= 2 * METER_STEP);
}

// Half of the hair in its own shade: black counts as a thousandth of what is bright, log2(1000)
// stops below it, and so does all that is darker still.
static void black_counts_as_a_thousandth(void **state)
{
    (void)state;
    static const float blacks[] = {0, 1e-9f, 1e-5f, 0.99e-3f};
    for (int stops = 2; stops < 9; ++stops) {
        float light = (float)(METER_MIDDLE * exp2(-stops));
        double expected = (1 - METER_KEPT) * (stops + log2(1000) / 2);
        double limit = log2(METER_WHITE / (double)light);
        for (size_t i = 0; i < sizeof blacks / sizeof *blacks; ++i) {
            const Tile tiles[] = {{200, light, 1}, {200, blacks[i] * light, 1}};
            double found = meter(tiles, 2);
            assert_true(fabs(found - fmin(expected, limit)) <= METER_STEP / 2);
        }
        // Above it each shade counts as what it is.
        const Tile tiles[] = {{200, light, 1}, {200, 4e-3f * light, 1}};
        expected = (1 - METER_KEPT) * (stops + log2(250) / 2);
        assert_true(fabs(meter(tiles, 2) - fmin(expected, limit)) <= METER_STEP / 2);
    }
}

// Hair that is all dark is not taken for nothing: a millionth of the middle gives 20 stops less
// what is kept.
static void dark_hair_is_lit_by_what_it_is_darker(void **state)
{
    (void)state;
    for (int stops = 10; stops <= 30; stops += 5) {
        double expected = stops * (1 - METER_KEPT);
        assert_true(fabs(meter_all(METER_MIDDLE * exp2(-stops)) - expected) <= METER_STEP / 2);
    }
}

// Luminance of red, green and blue (ITU-R BT.709), of half-covered pixels over their coverage.
static void colours_count_by_their_luminance(void **state)
{
    (void)state;
    static const double weights[3] = {0.2126, 0.7152, 0.0722};
    for (int c = 0; c < 3; ++c) {
        Image image;
        float found = NAN;
        assert_int_equal(image_create_kind(&image, SIDE, SIDE, 4, IMAGE_FLOAT, NULL), RESULT_OK);
        float *pixel = (float *)(void *)image.pixels;
        for (int i = 0; i < SIDE * SIDE; ++i, pixel += 4) {
            for (int k = 0; k < 3; ++k) pixel[k] = k == c ? 0.75f * 0.02f : 0;
            pixel[3] = 0.75f;
        }
        assert_int_equal(meter_exposure(&found, &image, NULL), RESULT_OK);
        assert_true((double)found == meter_all(0.02 * weights[c]));
        image_destroy(&image);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(an_even_grey_comes_to_the_middle_in_part),
        cmocka_unit_test(the_result_is_a_whole_number_of_steps),
        cmocka_unit_test(what_is_not_covered_does_not_count),
        cmocka_unit_test(nothing_and_black_have_no_exposure),
        cmocka_unit_test(highlights_stay_below_white),
        cmocka_unit_test(single_pixels_do_not_matter),
        cmocka_unit_test(black_counts_as_a_thousandth),
        cmocka_unit_test(dark_hair_is_lit_by_what_it_is_darker),
        cmocka_unit_test(colours_count_by_their_luminance),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
