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

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(an_even_grey_comes_to_the_middle_in_part),
        cmocka_unit_test(the_result_is_a_whole_number_of_steps),
        cmocka_unit_test(what_is_not_covered_does_not_count),
        cmocka_unit_test(nothing_and_black_have_no_exposure),
        cmocka_unit_test(highlights_stay_below_white),
        cmocka_unit_test(single_pixels_do_not_matter),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
