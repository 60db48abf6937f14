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
    float bald;            // share of the pixel without hair
} Tile;

// Meters an image that consists of these tiles.
static double meter(const Tile *tiles, int count, Tone tone)
{
    Image image, hair;
    float exposure = NAN;
    int left = SIDE * SIDE;
    assert_int_equal(image_create_kind(&image, SIDE, SIDE, 4, IMAGE_FLOAT, NULL), RESULT_OK);
    assert_int_equal(image_create_kind(&hair, SIDE, SIDE, 4, IMAGE_FLOAT, NULL), RESULT_OK);
    float *pixel = (float *)(void *)image.pixels, *share = (float *)(void *)hair.pixels;
    for (int i = 0; i < count; ++i)
        for (int k = 0; k < tiles[i].count && left > 0; ++k, --left, pixel += 4, share += 4) {
            for (int c = 0; c < 3; ++c) pixel[c] = tiles[i].light * tiles[i].coverage;
            pixel[3] = tiles[i].coverage;
            share[0] = 1 - tiles[i].bald;
        }
    assert_int_equal(left, 0);
    assert_int_equal(meter_exposure(&exposure, &image, &hair, tone, NULL), RESULT_OK);
    image_destroy(&image);
    image_destroy(&hair);
    return (double)exposure;
}

static double meter_all(double light)
{
    return meter(&(Tile){SIDE * SIDE, (float)light, 1, 0}, 1, TONE_NONE);
}

// With every tone curve.
static void even_hair_shows_as_the_grey_that_it_is(void **state)
{
    (void)state;
    for (Tone tone = TONE_NONE; tone <= TONE_FILMIC; ++tone)
        for (int stops = -8; stops <= 8; ++stops) {
            const Tile tile = {SIDE * SIDE, (float)(METER_GREY * exp2(stops)), 1, 0};
            double shown = tone_map(tone, (double)tile.light * exp2(meter(&tile, 1, tone)));
            // Half a step of exposure, and as much again for the curve's steepest slope.
            assert_true(fabs(log2(shown / METER_GREY)) <= METER_STEP);
        }
}

// Three quarters of the pixels are dark and a quarter is bright: their mean after the tone curve is
// METER_GREY.
static void it_is_the_mean_shown_that_counts(void **state)
{
    (void)state;
    for (Tone tone = TONE_NONE; tone <= TONE_FILMIC; ++tone) {
        const Tile tiles[] = {{300, 0.02f, 1, 0}, {100, 0.2f, 1, 0}};
        double scale = exp2(meter(tiles, 2, tone)),
               shown = 0.75 * tone_map(tone, 0.02 * scale) + 0.25 * tone_map(tone, 0.2 * scale);
        assert_true(fabs(log2(shown / METER_GREY)) <= METER_STEP);
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
    const Tile tiles[] = {{100, 0.02f, 1, 0}, {200, 9, 0.49f, 0}, {100, 5, 0, 0}};
    assert_true(meter(tiles, 3, TONE_NONE) == meter_all(0.02));
    const Tile half[] = {{200, 0.02f, 0.51f, 0}, {200, 9, 0, 0}};
    assert_true(meter(half, 2, TONE_NONE) == meter_all(0.02));
}

static void a_mesh_counts_where_there_is_no_hair_alone(void **state)
{
    (void)state;
    const Tile tiles[] = {{100, 0.02f, 1, 0.49f}, {300, 0.08f, 1, 0.51f}};
    assert_true(meter(tiles, 2, TONE_NONE) == meter_all(0.02));
    const Tile bald[] = {{400, 0.08f, 1, 1}};
    assert_true(meter(bald, 1, TONE_NONE) == meter_all(0.08));
}

static void nothing_and_black_have_no_exposure(void **state)
{
    (void)state;
    assert_true(meter(&(Tile){SIDE * SIDE, 1, 0, 0}, 1, TONE_NONE) == 0);
    assert_true(meter_all(0) == 0);
}

// 4 % of the pixels, which show a mesh, are 50 times as bright as the hair.
static void highlights_stay_below_white(void **state)
{
    (void)state;
    const Tile tiles[] = {{384, 0.01f, 1, 0}, {16, 0.5f, 1, 1}};
    assert_true(fabs(meter(tiles, 2, TONE_NONE) - log2(METER_WHITE / 0.5)) <= METER_STEP / 2);
    const Tile fewer[] = {{390, 0.01f, 1, 0}, {10, 0.5f, 1, 1}};
    assert_true(meter(fewer, 2, TONE_NONE) == meter_all(0.01));
}

// Luminance of red, green and blue (ITU-R BT.709); half-covered pixels are divided by their
// coverage.
static void colours_count_by_their_luminance(void **state)
{
    (void)state;
    static const double weights[3] = {0.2126, 0.7152, 0.0722};
    for (int c = 0; c < 3; ++c) {
        Image image, hair;
        float found = NAN;
        assert_int_equal(image_create_kind(&image, SIDE, SIDE, 4, IMAGE_FLOAT, NULL), RESULT_OK);
        assert_int_equal(image_create_kind(&hair, SIDE, SIDE, 4, IMAGE_FLOAT, NULL), RESULT_OK);
        float *pixel = (float *)(void *)image.pixels;
        for (int i = 0; i < SIDE * SIDE; ++i, pixel += 4) {
            for (int k = 0; k < 3; ++k) pixel[k] = k == c ? 0.75f * 0.02f : 0;
            pixel[3] = 0.75f;
        }
        assert_int_equal(meter_exposure(&found, &image, &hair, TONE_NONE, NULL), RESULT_OK);
        assert_true((double)found == meter_all(0.02 * weights[c]));
        image_destroy(&image);
        image_destroy(&hair);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(even_hair_shows_as_the_grey_that_it_is),
        cmocka_unit_test(it_is_the_mean_shown_that_counts),
        cmocka_unit_test(the_result_is_a_whole_number_of_steps),
        cmocka_unit_test(what_is_not_covered_does_not_count),
        cmocka_unit_test(a_mesh_counts_where_there_is_no_hair_alone),
        cmocka_unit_test(nothing_and_black_have_no_exposure),
        cmocka_unit_test(highlights_stay_below_white),
        cmocka_unit_test(colours_count_by_their_luminance),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
