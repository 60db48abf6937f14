// SPDX-License-Identifier: MIT
// Images of turntables: hair and mesh reach the margin, and the turntable loops.
#include "image/png.h"
#include "support/temporary.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

enum { WIDTH = 160, HEIGHT = 120 };

// Where light is no claim.
#define PLAIN "--look plain "

// Runs tractrix-render with these arguments; the images go to FOLDER.
static void render(void **state, const char *arguments, const char *folder)
{
    char line[1500];
    const char *programs = getenv("TRACTRIX_BIN");
    snprintf(line, sizeof line, "%s/tractrix-render %s --size %dx%d -q -o '%s/'",
             programs ? programs : "out/release", arguments, WIDTH, HEIGHT,
             temporary_path(state, folder));
    assert_int_equal(system(line), 0);
}

static void read_frame(void **state, const char *folder, int frame, Image *image)
{
    Error error;
    char name[64];
    snprintf(name, sizeof name, "%s/frame_%04d.png", folder, frame);
    assert_int_equal(png_read(image, temporary_path(state, name), &error), RESULT_OK);
    assert_true(image->width == WIDTH && image->height == HEIGHT);
}

// The largest distance of the far edge of a visible pixel from the image's middle, in pixels.
static void find_reach(const Image *image, double reach[2])
{
    assert_int_equal(image->channels, 4);
    for (int y = 0; y < HEIGHT; ++y)
        for (int x = 0; x < WIDTH; ++x) {
            if (!image->pixels[4 * (y * WIDTH + x) + 3]) continue;
            reach[0] = fmax(reach[0], fmax(WIDTH / 2.0 - x, x + 1 - WIDTH / 2.0));
            reach[1] = fmax(reach[1], fmax(HEIGHT / 2.0 - y, y + 1 - HEIGHT / 2.0));
        }
}

// Content fills 1 / 1.25 of the image's half size. Every touched pixel is drawn, so that up to one
// more is visible; the last two pixels of a pointed tip may be too faint to be visible.
static void margins_are_kept(void **state, const char *arguments)
{
    enum { FRAMES = 16 };
    char line[1000];
    double reach[2] = {0, 0};
    const double limit[2] = {WIDTH / 2.5, HEIGHT / 2.5};
    snprintf(line, sizeof line,
             "%s --turntable 360 --margin 0.25 --frames %d --background transparent", arguments,
             FRAMES);
    render(state, line, "turn");
    for (int frame = 0; frame < FRAMES; ++frame) {
        Image image;
        read_frame(state, "turn", frame, &image);
        find_reach(&image, reach);
        image_destroy(&image);
    }
    assert_true(reach[0] <= limit[0] + 1 && reach[1] <= limit[1] + 1);
    assert_true(reach[0] >= limit[0] - 2 || reach[1] >= limit[1] - 2);
}

static void still_hair_touches_the_margin_and_keeps_it(void **state)
{
    margins_are_kept(state, PLAIN "assets/curls.tfx --algo none");
}

static void so_does_hair_in_the_wind_on_a_moving_head_with_a_mesh(void **state)
{
    margins_are_kept(state, PLAIN
                     "assets/demo.json --followers 2 --style 0 --wind 3,0,0 --drag 3 --speed 4");
}

static void so_do_followers_drawn_from_a_cache(void **state)
{
    const char *hair =
        PLAIN "assets/curls.tfx --followers 3 --follower-radius 0.02 --tip-separation 2 "
              "--style 0.3 --turntable 360 --margin 0.25 --frames 16";
    char line[1000];
    snprintf(line, sizeof line, "%s/tractrix-render %s -q --cache '%s'", getenv("TRACTRIX_BIN"),
             hair, temporary_path(state, "x.cache"));
    assert_int_equal(system(line), 0);
    snprintf(line, sizeof line, "%s --from-cache '%s'", hair, temporary_path(state, "x.cache"));
    margins_are_kept(state, line);
}

static void assert_same(void **state, const char *a, int frame_a, const char *b, int frame_b)
{
    Image first, second;
    read_frame(state, a, frame_a, &first);
    read_frame(state, b, frame_b, &second);
    assert_memory_equal(first.pixels, second.pixels, image_size(&first));
    image_destroy(&first);
    image_destroy(&second);
}

// A second turn shows the same images as the first: the frame after the last equals the first.
// --speed 0 also stops the wind of the warm-up. Shadow maps must loop as well.
static void still_hair_loops_to_the_byte(void **state)
{
    const char *hair = "assets/curls.tfx --scatter none --exposure 0 --wind 4,0,0 --preroll 0.3 "
                       "--speed 0 --ease-in 0";
    char line[300];
    snprintf(line, sizeof line, "%s --frames 5 --turntable 360", hair);
    render(state, line, "once");
    snprintf(line, sizeof line, "%s --frames 10 --turntable 720", hair);
    render(state, line, "twice");
    for (int frame = 0; frame < 10; ++frame) assert_same(state, "once", frame % 5, "twice", frame);
}

// Each tile equals the frame's own image.
static void a_contact_sheet_shows_the_frames(void **state)
{
    enum { COLUMNS = 3, ROWS = 2 };
    Error error;
    Image sheet;
    char line[1000];
    const char *hair = PLAIN "assets/fur.tfx --frames 12 --turntable 360";
    render(state, hair, "all");
    snprintf(line, sizeof line,
             "%s/tractrix-render %s --size %dx%d -q --contact-sheet %dx%d -o '%s'",
             getenv("TRACTRIX_BIN"), hair, WIDTH, HEIGHT, COLUMNS, ROWS,
             temporary_path(state, "sheet.png"));
    assert_int_equal(system(line), 0);
    assert_int_equal(png_read(&sheet, temporary_path(state, "sheet.png"), &error), RESULT_OK);
    assert_true(sheet.width == COLUMNS * WIDTH && sheet.height == ROWS * HEIGHT);
    for (int tile = 0; tile < COLUMNS * ROWS; ++tile) {
        Image image;
        read_frame(state, "all", 2 * tile, &image);
        for (int y = 0; y < HEIGHT; ++y) {
            int at = (tile / COLUMNS * HEIGHT + y) * sheet.width + tile % COLUMNS * WIDTH;
            assert_memory_equal(sheet.pixels + 3 * at, image.pixels + 3 * y * WIDTH, 3 * WIDTH);
        }
        image_destroy(&image);
    }
    image_destroy(&sheet);
}

#define TEST(name) cmocka_unit_test_setup_teardown(name, temporary_create, temporary_destroy)

int main(void)
{
    const struct CMUnitTest tests[] = {
        TEST(still_hair_touches_the_margin_and_keeps_it),
        TEST(so_does_hair_in_the_wind_on_a_moving_head_with_a_mesh),
        TEST(so_do_followers_drawn_from_a_cache),
        TEST(still_hair_loops_to_the_byte),
        TEST(a_contact_sheet_shows_the_frames),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
