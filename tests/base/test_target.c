// SPDX-License-Identifier: MIT
// Names of output files and the formats they select.
#include "base/target.h"
#include "support/temporary.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#include <cmocka.h>

static void assert_name(const char *text, TargetKind kind, int frame, const char *expected)
{
    Target target;
    Error error;
    assert_int_equal(target_parse(&target, text, &error), RESULT_OK);
    assert_int_equal(target.kind, kind);
    char *name = target_name_frame(&target, frame);
    assert_string_equal(name, expected);
    free(name);
    target_destroy(&target);
}

static void frames_are_named_by_their_number(void **state)
{
    (void)state;
    assert_name("out/demo/", TARGET_FRAMES, 0, "out/demo/frame_0000.png");
    assert_name("out/", TARGET_FRAMES, 9999, "out/frame_9999.png");
    assert_name("a_%d.png", TARGET_FRAMES, 12, "a_12.png");
    assert_name("b/%03dx.PNG", TARGET_FRAMES, 7, "b/007x.PNG");
    assert_name("100%%_%02d_%%d.png", TARGET_FRAMES, 5, "100%_05_%d.png");
    assert_name("%09d.png", TARGET_FRAMES, 1, "000000001.png");
}

static void numbers_widen_beyond_their_digits(void **state)
{
    (void)state;
    assert_name("out/", TARGET_FRAMES, 10000, "out/frame_10000.png");
    assert_name("x_%02d.png", TARGET_FRAMES, 2147483647, "x_2147483647.png");
}

static void stills_and_videos_have_one_name(void **state)
{
    (void)state;
    assert_name("x.png", TARGET_STILL, 3, "x.png");
    assert_name("50%%.png", TARGET_STILL, 3, "50%.png");
    assert_name("x.JPG", TARGET_STILL, 3, "x.JPG");
    assert_name("x_%02d.jpeg", TARGET_FRAMES, 3, "x_03.jpeg");
    assert_name("a/x.mp4", TARGET_VIDEO, 3, "a/x.mp4");
    assert_name("x%04d.WebM", TARGET_VIDEO, 3, "x%04d.WebM");
    assert_name("x.gif", TARGET_VIDEO, 3, "x.gif");
}

// A dash, or a dash with a suffix, is standard output, in the formats that can be written in one
// piece. A dash at the beginning of a longer name means nothing.
static void dashes_are_standard_output(void **state)
{
    (void)state;
    static const struct {
        const char *text;
        TargetFormat format;
        TargetKind kind;
        bool stream;
    } cases[] = {
        {"-", TARGET_PNG, TARGET_VIDEO, true},        {"-.png", TARGET_PNG, TARGET_VIDEO, true},
        {"-.PNG", TARGET_PNG, TARGET_VIDEO, true},    {"-.y4m", TARGET_Y4M, TARGET_VIDEO, true},
        {"-.pfm", TARGET_PFM, TARGET_STILL, true},    {"-.exr", TARGET_EXR, TARGET_STILL, true},
        {"./-.y4m", TARGET_Y4M, TARGET_VIDEO, false}, {"-x.png", TARGET_PNG, TARGET_STILL, false},
        {"--.pfm", TARGET_PFM, TARGET_STILL, false}};
    for (size_t i = 0; i < sizeof cases / sizeof *cases; ++i) {
        Target target;
        Error error = {{0}};
        assert_int_equal(target_parse(&target, cases[i].text, &error), RESULT_OK);
        assert_int_equal(target.format, cases[i].format);
        assert_int_equal(target.kind, cases[i].kind);
        assert_true(target.stream == cases[i].stream);
        assert_true(target.floats == (cases[i].kind == TARGET_STILL && i != 7));
        target_destroy(&target);
    }
}

static void an_existing_folder_needs_no_slash(void **state)
{
    Error error;
    char expected[600];
    const char *folder = temporary_path(state, "there.mp4");
    snprintf(expected, sizeof expected, "%s/frame_0001.png", folder);
    assert_int_equal(mkdir(folder, 0777), 0);
    assert_name(folder, TARGET_FRAMES, 1, expected);
    Target target;
    assert_int_equal(target_parse(&target, temporary_path(state, "absent"), &error), RESULT_USAGE);
    target_destroy(&target);
}

static void targets_without_sense_are_usage_errors(void **state)
{
    (void)state;
    static const char *const texts[] = {"no/such_name",
                                        "x.bmp",
                                        "x_%d_%d.png",
                                        "x_%s.png",
                                        "x_%5d.png",
                                        "x_%00d.png",
                                        "x_%",
                                        "x_%012d.png",
                                        "%d/x_y.png",
                                        "x_%04d_%.png",
                                        "x_%04d.png.mpg",
                                        ".png",
                                        ".mp4",
                                        "-.jpg",
                                        "-.mp4",
                                        "-.",
                                        "-x",
                                        ""};
    for (size_t i = 0; i < sizeof texts / sizeof *texts; i++) {
        Target target;
        Error error = {{0}};
        assert_int_equal(target_parse(&target, texts[i], &error), RESULT_USAGE);
        assert_non_null(strstr(error.text, texts[i]));
        assert_null(strchr(error.text, '\n'));
        assert_null(target.before);
        target_destroy(&target);
    }
}

static void missing_folders_are_made_and_nothing_else(void **state)
{
    Target target;
    Error error;
    assert_int_equal(target_parse(&target, temporary_path(state, "a/b//c/"), &error), RESULT_OK);
    assert_int_equal(target_prepare(&target, &error), RESULT_OK);
    assert_int_equal(target_prepare(&target, &error), RESULT_OK);
    assert_int_equal(temporary_count_files(temporary_path(state, "a/b/c")), 0);
    target_destroy(&target);
}

#define TEST(name) cmocka_unit_test_setup_teardown(name, temporary_create, temporary_destroy)

int main(void)
{
    const struct CMUnitTest tests[] = {
        TEST(frames_are_named_by_their_number),
        TEST(numbers_widen_beyond_their_digits),
        TEST(stills_and_videos_have_one_name),
        TEST(dashes_are_standard_output),
        TEST(an_existing_folder_needs_no_slash),
        TEST(targets_without_sense_are_usage_errors),
        TEST(missing_folders_are_made_and_nothing_else),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
