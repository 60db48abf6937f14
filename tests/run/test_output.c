// SPDX-License-Identifier: MIT
// Writing frames to files and contact sheets. Videos and their interruption are in
// test_output_video.c.
#include "image/png.h"
#include "support/grey_frames.h"
#include "support/temporary.h"

#include <setjmp.h>
#include <signal.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cmocka.h>

static void frames_go_to_a_new_folder_each_with_its_content(void **state)
{
    Error error;
    for (int channels = 3; channels <= 4; channels++) {
        OutputOptions options =
            grey_options(temporary_path(state, channels == 3 ? "a/b/" : "c/"), channels);
        assert_int_equal(grey_write(&options, 20, &error), RESULT_OK);
        assert_int_equal(temporary_count_files(options.target), 20);
        for (int frame = 0; frame < 20; frame++) {
            char path[600];
            snprintf(path, sizeof path, "%sframe_%04d.png", options.target, frame);
            grey_assert_frame(path, frame, channels);
        }
    }
}

static void counters_and_description_tell_what_was_written(void **state)
{
    Error error;
    Output *output;
    OutputOptions options = grey_options(temporary_path(state, "x_%d.png"), 3);
    assert_int_equal(output_create(&output, &options, &error), RESULT_OK);
    assert_int_equal(grey_draw(output, 12, &error), RESULT_OK);
    assert_int_equal(output_finish(output, &error), RESULT_OK);
    OutputCounters counters = output_count(output);
    assert_int_equal(counters.frames, 12);
    assert_true(counters.encode_ms > 0.0);
    uint64_t bytes = 0;
    for (int frame = 0; frame < 12; frame++) {
        char name[32];
        struct stat status;
        snprintf(name, sizeof name, "x_%d.png", frame);
        assert_int_equal(stat(temporary_path(state, name), &status), 0);
        bytes += (uint64_t)status.st_size;
    }
    assert_int_equal(counters.bytes, bytes);
    char expected[1100];
    snprintf(expected, sizeof expected, "%s ... %s", temporary_path(state, "x_0.png"),
             temporary_path(state, "x_11.png"));
    assert_string_equal(output_describe(output), expected);
    output_destroy(output);
}

static void a_single_name_takes_a_single_frame(void **state)
{
    Error error;
    OutputOptions options = grey_options(temporary_path(state, "still.png"), 3);
    options.frame_count = 1;
    assert_int_equal(grey_write(&options, 1, &error), RESULT_OK);
    grey_assert_frame(options.target, 0, 3);
    options.frame_count = 2;
    assert_int_equal(grey_write(&options, 2, &error), RESULT_USAGE);
    grey_assert_line(&error, "frame_%04d.png");
}

static void formats_refuse_what_they_cannot_hold(void **state)
{
    Error error;
    OutputOptions options = grey_options(temporary_path(state, "x.mp4"), 4);
    assert_int_equal(grey_write(&options, 1, &error), RESULT_USAGE);
    grey_assert_line(&error, "transparent");
    options.target = temporary_path(state, "x.gif");
    assert_int_equal(grey_write(&options, 1, &error), RESULT_USAGE);
    options.channels = 3;
    options.fps = 1001.0;
    assert_int_equal(grey_write(&options, 1, &error), RESULT_USAGE);
    grey_assert_line(&error, "at most 1000");
    assert_int_equal(temporary_count_files(temporary_path(state, ".")), 0);
}

static void a_target_that_cannot_be_written_fails_before_any_frame(void **state)
{
    static const char *const names[] = {"plain/", "plain/x_%d.png", "plain/below/", "plain/x.mp4"};
    temporary_write(state, "plain", "a file, no folder", 0644);
    for (int i = 0; i < 4; i++) {
        Error error = {{0}};
        Output *output;
        OutputOptions options = grey_options(temporary_path(state, names[i]), 3);
        assert_int_equal(output_create(&output, &options, &error), RESULT_FAILED);
        assert_null(output);
        grey_assert_line(&error, temporary_path(state, "plain"));
        grey_assert_line(&error, "Not a directory");
    }
}

static void a_read_only_folder_fails_before_any_frame(void **state)
{
    if (geteuid() == 0) {
        puts("skipped: root may write into read-only folders");
        skip();
    }
    Error error;
    Output *output;
    mkdir(temporary_path(state, "locked"), 0555);
    OutputOptions options = grey_options(temporary_path(state, "locked/"), 3);
    assert_int_equal(output_create(&output, &options, &error), RESULT_FAILED);
    grey_assert_line(&error, "Permission denied");
}

// A limit of file sizes imitates a full disk: writes are cut short in the same way.
static void a_full_disk_ends_the_run_with_path_and_reason(void **state)
{
    Error error, again;
    Output *output;
    Image *image;
    OutputOptions options = grey_options(temporary_path(state, "full/"), 3);
    struct rlimit limit, small;
    getrlimit(RLIMIT_FSIZE, &limit);
    small = limit;
    small.rlim_cur = 64;
    assert_int_equal(output_create(&output, &options, &error), RESULT_OK);
    setrlimit(RLIMIT_FSIZE, &small);
    Result result = grey_draw(output, 100, &error);
    setrlimit(RLIMIT_FSIZE, &limit);
    assert_int_equal(result, RESULT_FAILED);
    grey_assert_line(&error, temporary_path(state, "full/frame_0000.png"));
    grey_assert_line(&error, "File too large");
    assert_int_equal(output_acquire(output, &image, &again), RESULT_FAILED);
    assert_null(image);
    assert_string_equal(again.text, error.text);
    assert_int_equal(output_finish(output, &again), RESULT_FAILED);
    assert_string_equal(again.text, error.text);
    assert_int_equal(output_count(output).frames, 0);
    output_destroy(output);
    assert_int_equal(temporary_count_files(options.target), 0);
}

static void destroying_early_leaves_whole_files_only(void **state)
{
    Error error;
    Output *output;
    Image *image;
    OutputOptions options = grey_options(temporary_path(state, "early/"), 3);
    assert_int_equal(output_create(&output, &options, &error), RESULT_OK);
    assert_int_equal(grey_draw(output, 10, &error), RESULT_OK);
    assert_int_equal(output_acquire(output, &image, &error), RESULT_OK);
    output_destroy(output);
    int count = temporary_count_files(options.target);
    assert_in_range(count, 0, 10);
    for (int frame = 0; frame < count; frame++) {
        char name[40];
        snprintf(name, sizeof name, "early/frame_%04d.png", frame);
        grey_assert_frame(temporary_path(state, name), frame, 3);
    }
    output_destroy(NULL);
}

static void the_pool_lends_no_more_images_than_it_has(void **state)
{
    Error error;
    Output *output;
    const Image *seen[2] = {NULL, NULL};
    OutputOptions options = grey_options(temporary_path(state, "pool_%02d.png"), 3);
    options.queue_length = 2;
    assert_int_equal(output_create(&output, &options, &error), RESULT_OK);
    for (int frame = 0; frame < 20; frame++) {
        Image *image;
        assert_int_equal(output_acquire(output, &image, &error), RESULT_OK);
        if (!seen[0] || seen[0] == image)
            seen[0] = image;
        else if (!seen[1])
            seen[1] = image;
        else
            assert_ptr_equal(image, seen[1]);
        grey_fill(image, frame);
        assert_int_equal(output_submit(output, frame, image, &error), RESULT_OK);
    }
    assert_int_equal(output_finish(output, &error), RESULT_OK);
    output_destroy(output);
    grey_assert_frame(temporary_path(state, "pool_00.png"), 0, 3);
    grey_assert_frame(temporary_path(state, "pool_19.png"), 19, 3);
}

// Tiles are in reading order, and the rest is black. Every byte is compared.
static void a_contact_sheet_holds_its_frames_in_order(void **state)
{
    enum { COLUMNS = 3, ROWS = 2, FRAMES = 5 };
    Error error;
    Image image;
    const char *path = temporary_path(state, "new/sheet.png");
    OutputOptions options = grey_options(path, 3);
    options.columns = COLUMNS, options.rows = ROWS, options.frame_count = FRAMES;
    assert_int_equal(grey_write(&options, FRAMES, &error), RESULT_OK);
    assert_int_equal(temporary_count_files(temporary_path(state, "new")), 1);
    assert_int_equal(png_read(&image, path, &error), RESULT_OK);
    assert_true(image.width == COLUMNS * GREY_WIDTH && image.height == ROWS * GREY_HEIGHT);
    for (int y = 0; y < image.height; y++)
        for (int x = 0; x < image.width; x++) {
            int tile = y / GREY_HEIGHT * COLUMNS + x / GREY_WIDTH;
            uint8_t grey = tile < FRAMES ? grey_of_frame(tile) : 0;
            for (int k = 0; k < 3; k++)
                assert_int_equal(image.pixels[3 * (y * image.width + x) + k], grey);
        }
    image_destroy(&image);
}

static void a_contact_sheet_is_one_picture_of_less_than_1_gib(void **state)
{
    Error error;
    static const char *const names[] = {"x.mp4", "x_%d.png", "o/"};
    for (int i = 0; i < 3; i++) {
        OutputOptions options = grey_options(temporary_path(state, names[i]), 3);
        options.columns = 2, options.rows = 1;
        assert_int_equal(grey_write(&options, 1, &error), RESULT_USAGE);
        grey_assert_line(&error, "contact sheet");
    }
    OutputOptions options = grey_options(temporary_path(state, "x.png"), 4);
    options.columns = options.rows = 1000;
    assert_int_equal(grey_write(&options, 1, &error), RESULT_USAGE);
    grey_assert_line(&error, "1 GiB");
    assert_int_equal(temporary_count_files(temporary_path(state, ".")), 0);
}

static void destroying_a_contact_sheet_early_leaves_nothing(void **state)
{
    Error error;
    Output *output;
    OutputOptions options = grey_options(temporary_path(state, "sheet.png"), 3);
    options.columns = options.rows = 2;
    assert_int_equal(output_create(&output, &options, &error), RESULT_OK);
    assert_int_equal(grey_draw(output, 3, &error), RESULT_OK);
    output_destroy(output);
    assert_int_equal(temporary_count_files(temporary_path(state, ".")), 0);
}

#define TEST(name) cmocka_unit_test_setup_teardown(name, temporary_create, temporary_destroy)

int main(void)
{
    const struct CMUnitTest tests[] = {
        TEST(frames_go_to_a_new_folder_each_with_its_content),
        TEST(counters_and_description_tell_what_was_written),
        TEST(a_single_name_takes_a_single_frame),
        TEST(formats_refuse_what_they_cannot_hold),
        TEST(a_target_that_cannot_be_written_fails_before_any_frame),
        TEST(a_read_only_folder_fails_before_any_frame),
        TEST(a_full_disk_ends_the_run_with_path_and_reason),
        TEST(destroying_early_leaves_whole_files_only),
        TEST(the_pool_lends_no_more_images_than_it_has),
        TEST(a_contact_sheet_holds_its_frames_in_order),
        TEST(a_contact_sheet_is_one_picture_of_less_than_1_gib),
        TEST(destroying_a_contact_sheet_early_leaves_nothing),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
