// SPDX-License-Identifier: MIT
// Images of any size are covered by few tiles, which are within the driver's limits and fit into
// memory.
#include "draw/tiles.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

static const GpuLimits LIMITS = {.framebuffer_side_px = 16384};

static void check(int width, int height, int samples, int64_t most, int expected)
{
    Tiles tiles = tiles_divide(&LIMITS, width, height, samples, most);
    int64_t wide = (int64_t)tiles.width * samples, high = (int64_t)tiles.height * samples;
    assert_int_equal(tiles_count(&tiles), expected);
    assert_true(tiles.columns * tiles.width >= width && tiles.rows * tiles.height >= height);
    assert_true(wide <= LIMITS.framebuffer_side_px && high <= LIMITS.framebuffer_side_px);
    assert_true(wide * high <= most || tiles.height == 1);
    // No tile lies outside the image.
    int place[2];
    tiles_place(&tiles, expected - 1, place);
    assert_true(place[0] < width && place[1] < height);
}

static void tiles_cover_the_image_and_fit_the_driver(void **state)
{
    (void)state;
    const int64_t most = TILE_MOST_SAMPLES;
    check(1280, 720, 1, most, 1);
    check(3840, 2160, 2, most, 1);
    check(8192, 8192, 1, most, 1);
    check(16384, 16384, 1, most, 4);
    check(8192, 4320, 4, most, 10);
    check(16384, 16384, 4, most, 64);
    check(16384, 1, 4, most, 4);
    check(1, 16384, 4, most, 4);
    check(7, 5, 1, 1, 5); // at least one row
    check(1, 1, 4, 1, 1);
}

// Every pixel of a 7 x 5 image comes from its place in the right tile.
static void what_hangs_over_is_left_out(void **state)
{
    (void)state;
    const GpuLimits small = {.framebuffer_side_px = 3};
    Tiles tiles = tiles_divide(&small, 7, 5, 1, 100);
    Image image, tile;
    assert_int_equal(tiles_count(&tiles), 6);
    assert_int_equal(image_create(&image, 7, 5, 3, NULL), RESULT_OK);
    assert_int_equal(image_create(&tile, tiles.width, tiles.height, 3, NULL), RESULT_OK);
    memset(image.pixels, 0, image_size(&image));
    for (int i = 0; i < tiles_count(&tiles); ++i) {
        int place[2];
        tiles_place(&tiles, i, place);
        for (int y = 0; y < tile.height; ++y)
            for (int x = 0; x < tile.width; ++x)
                memset(&tile.pixels[3 * (y * tile.width + x)],
                       1 + (place[1] + y) * 16 + place[0] + x, 3);
        tiles_copy(&tiles, i, &tile, &image);
    }
    for (int p = 0; p < 7 * 5; ++p)
        for (int c = 0; c < 3; ++c)
            assert_int_equal(image.pixels[3 * p + c], 1 + p / 7 * 16 + p % 7);
    image_destroy(&tile);
    image_destroy(&image);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(tiles_cover_the_image_and_fit_the_driver),
        cmocka_unit_test(what_hangs_over_is_left_out),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
