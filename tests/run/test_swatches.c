// SPDX-License-Identifier: MIT
// Lit hair shows the colour given by --color, and all colours of a groom get the same exposure.
#include "image/png.h"
#include "support/temporary.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

static const char HEAD[] = "--mesh assets/head.obj", BALL[] = "--mesh assets/ball.obj";

static const char *find_programs(void)
{
    const char *programs = getenv("TRACTRIX_BIN");
    return programs ? programs : "out/release";
}

// Runs tractrix-render; the image is DIR/NAME.png, its output DIR/NAME.txt. Always by blocks, also
// if a hardware GPU is imitated: loops of CPU drivers are too short for the many ribbons in a tile
// of a small image.
static void render(void **state, const char *groom, const char *mesh, const char *more,
                   const char *name)
{
    char line[1500];
    const char *folder = temporary_path(state, "");
    snprintf(line, sizeof line,
             "%s/tractrix-render '%s' %s --algo none --raster blocks --size 72x72 %s -o "
             "'%s/%s.png' "
             "2>'%s/%s.txt'",
             find_programs(), groom, mesh, more, folder, name, folder, name);
    assert_int_equal(system(line), 0);
}

// The exposure in EV that the run of that name chose.
static double find_exposure(void **state, const char *name)
{
    char text[400] = "", file[64];
    double exposure;
    snprintf(file, sizeof file, "%s.txt", name);
    FILE *stream = fopen(temporary_path(state, file), "r");
    assert_non_null(stream);
    while (fgets(text, sizeof text, stream) && strncmp(text, "exposure:", 9) != 0) {
    }
    fclose(stream);
    assert_int_equal(sscanf(text, "exposure: %lf EV", &exposure), 1);
    return exposure;
}

static void read_image(void **state, const char *name, Image *image)
{
    Error error;
    char file[64];
    snprintf(file, sizeof file, "%s.png", name);
    assert_int_equal(png_read(image, temporary_path(state, file), &error), RESULT_OK);
}

// The mean light of pixels that hair covers by nine tenths or more, as sRGB levels.
static void find_mean(void **state, double mean[3])
{
    Image image, cover;
    int count = 0;
    read_image(state, "light", &image);
    read_image(state, "cover", &cover);
    memset(mean, 0, 3 * sizeof *mean);
    for (int i = 0; i < image.width * image.height; ++i) {
        if (cover.pixels[i * cover.channels] < 230) continue;
        ++count;
        for (int k = 0; k < 3; ++k)
            mean[k] += image_linear_from_srgb(image.pixels[i * image.channels + k] / 255.0);
    }
    assert_true(count > 300);
    for (int k = 0; k < 3; ++k) mean[k] = 255 * image_srgb_from_linear(mean[k] / count);
    image_destroy(&image);
    image_destroy(&cover);
}

// The colours of base/colors.c as numbers: they must equal the named colours.
static void a_lit_groom_has_its_colour_on_average(void **state)
{
    static const struct {
        const char *groom, *mesh, *color;
        int level[3];
    } cases[] = {
        {"demo", HEAD, "black", {0x26, 0x22, 0x20}},
        {"demo", HEAD, "dark-brown", {0x3b, 0x2a, 0x21}},
        {"demo", HEAD, "'#693527'", {0x69, 0x35, 0x27}},
        {"demo", HEAD, "white", {0x9c, 0x9a, 0x96}},
        {"bob", HEAD, "red", {0x82, 0x3f, 0x27}},
        {"bob", HEAD, "blond", {0x9c, 0x84, 0x5c}},
        {"fall", HEAD, "'#5e3f2b'", {0x5e, 0x3f, 0x2b}},
        {"curls", HEAD, "ginger", {0x9a, 0x58, 0x33}},
        {"curls", HEAD, "dark-blond", {0x8a, 0x71, 0x50}},
        {"fur", BALL, "grey", {0x7c, 0x79, 0x74}},
    };
    const char *last = "";
    double exposure = 0;
    for (size_t i = 0; i < sizeof cases / sizeof *cases; ++i) {
        char flags[100], groom[64];
        double mean[3];
        bool known = strcmp(cases[i].groom, last) == 0; // its exposure and coverage are known
        int length = snprintf(flags, sizeof flags, "--color %s", cases[i].color);
        if (known)
            snprintf(flags + length, sizeof flags - (size_t)length, " --exposure %.9g", exposure);
        snprintf(groom, sizeof groom, "assets/%s.tfx", cases[i].groom);
        render(state, groom, cases[i].mesh, flags, "light");
        if (!known) {
            exposure = find_exposure(state, "light");
            render(state, groom, cases[i].mesh, "--aov coverage", "cover");
        }
        last = cases[i].groom;
        find_mean(state, mean);
        for (int k = 0; k < 3; ++k)
            if (fabs(mean[k] / cases[i].level[k] - 1) > 0.15)
                fail_msg("%s %s: a mean of %.1f, %.1f, %.1f", cases[i].groom, cases[i].color,
                         mean[0], mean[1], mean[2]);
    }
}

// In whatever way the colour is given. A few strands are enough to be metered.
static void all_colours_have_one_exposure(void **state)
{
    static const char *const said[] = {"--color black",
                                       "--color white",
                                       "--albedo blond",
                                       "--melanin 8",
                                       "--transmission '#ff8000'",
                                       "--tip-length 1 --tip-color white"};
    char line[1000], few[500];
    snprintf(few, sizeof few, "%s", temporary_path(state, "few.tfx"));
    snprintf(line, sizeof line, "%s/tractrix-convert assets/curls.tfx --subsample 10%% -q -o '%s'",
             find_programs(), few);
    assert_int_equal(system(line), 0);
    double first = 0;
    for (size_t i = 0; i < sizeof said / sizeof *said; ++i) {
        char flags[100];
        snprintf(flags, sizeof flags, "--followers 0 --scatter-cells 12 --shadow-size 128 %s",
                 said[i]);
        render(state, few, "", flags, "one");
        double exposure = find_exposure(state, "one");
        if (i == 0) first = exposure;
        assert_true(exposure == first);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(a_lit_groom_has_its_colour_on_average, temporary_create,
                                        temporary_destroy),
        cmocka_unit_test_setup_teardown(all_colours_have_one_exposure, temporary_create,
                                        temporary_destroy),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
