// SPDX-License-Identifier: MIT
#include "interrupt.h"
#include "output.h"
#include "png.h"
#include "temporary.h"

#include <setjmp.h>
#include <signal.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/time.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cmocka.h>

enum { WIDTH = 33, HEIGHT = 17 };

static OutputOptions make_options(const char *target, int channels)
{
    return (OutputOptions){
        .target = target, .width = WIDTH, .height = HEIGHT, .channels = channels, .fps = 25.0};
}

// Every frame is of one grey, which tells its number; a real encoder changes it by less than half a
// step.
static uint8_t grey_of_frame(int frame)
{
    return (uint8_t)(20 + 10 * frame);
}

static void fill(Image *image, int frame)
{
    memset(image->pixels, grey_of_frame(frame),
           (size_t)image->width * (size_t)image->height * (size_t)image->channels);
}

// Draws frames until one of the calls fails.
static Result draw_frames(Output *output, int count, Error *error)
{
    Result result = RESULT_OK;
    for (int frame = 0; frame < count && result == RESULT_OK; frame++) {
        Image *image;
        result = output_acquire(output, &image, error);
        if (result != RESULT_OK) break;
        fill(image, frame);
        result = output_submit(output, frame, image, error);
    }
    return result;
}

static Result write_all(const OutputOptions *options, int count, Error *error)
{
    Output *output;
    Result result = output_create(&output, options, error);
    if (result == RESULT_OK) result = draw_frames(output, count, error);
    if (result == RESULT_OK) result = output_finish(output, error);
    output_destroy(output);
    return result;
}

static void assert_frame(const char *path, int frame, int channels)
{
    Error error;
    Image image;
    assert_int_equal(png_read(&image, path, &error), RESULT_OK);
    assert_int_equal(image.width, WIDTH);
    assert_int_equal(image.height, HEIGHT);
    assert_int_equal(image.channels, channels);
    for (int i = 0; i < WIDTH * HEIGHT * channels; i++)
        assert_int_equal(image.pixels[i], grey_of_frame(frame));
    image_destroy(&image);
}

static void assert_one_line_with(const Error *error, const char *part)
{
    assert_null(strchr(error->text, '\n'));
    if (!strstr(error->text, part)) fail_msg("'%s' lacks '%s'", error->text, part);
}

static void frames_go_to_a_new_folder_each_with_its_content(void **state)
{
    Error error;
    for (int channels = 3; channels <= 4; channels++) {
        OutputOptions options =
            make_options(temporary_path(state, channels == 3 ? "a/b/" : "c/"), channels);
        assert_int_equal(write_all(&options, 20, &error), RESULT_OK);
        assert_int_equal(temporary_count_files(options.target), 20);
        for (int frame = 0; frame < 20; frame++) {
            char path[600];
            snprintf(path, sizeof path, "%sframe_%04d.png", options.target, frame);
            assert_frame(path, frame, channels);
        }
    }
}

static void counters_and_description_tell_what_was_written(void **state)
{
    Error error;
    Output *output;
    OutputOptions options = make_options(temporary_path(state, "x_%d.png"), 3);
    assert_int_equal(output_create(&output, &options, &error), RESULT_OK);
    assert_int_equal(draw_frames(output, 12, &error), RESULT_OK);
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
    OutputOptions options = make_options(temporary_path(state, "still.png"), 3);
    options.frame_count = 1;
    assert_int_equal(write_all(&options, 1, &error), RESULT_OK);
    assert_frame(options.target, 0, 3);
    options.frame_count = 2;
    assert_int_equal(write_all(&options, 2, &error), RESULT_USAGE);
    assert_one_line_with(&error, "frame_%04d.png");
}

static void formats_refuse_what_they_cannot_hold(void **state)
{
    Error error;
    OutputOptions options = make_options(temporary_path(state, "x.mp4"), 4);
    assert_int_equal(write_all(&options, 1, &error), RESULT_USAGE);
    assert_one_line_with(&error, "transparent");
    options.target = temporary_path(state, "x.gif");
    assert_int_equal(write_all(&options, 1, &error), RESULT_USAGE);
    options.channels = 3;
    options.fps = 1001.0;
    assert_int_equal(write_all(&options, 1, &error), RESULT_USAGE);
    assert_one_line_with(&error, "at most 1000");
    assert_int_equal(temporary_count_files(temporary_path(state, ".")), 0);
}

static void a_target_that_cannot_be_written_fails_before_any_frame(void **state)
{
    static const char *const names[] = {"plain/", "plain/x_%d.png", "plain/below/", "plain/x.mp4"};
    temporary_write(state, "plain", "a file, no folder", 0644);
    for (int i = 0; i < 4; i++) {
        Error error = {{0}};
        Output *output;
        OutputOptions options = make_options(temporary_path(state, names[i]), 3);
        assert_int_equal(output_create(&output, &options, &error), RESULT_FAILED);
        assert_null(output);
        assert_one_line_with(&error, temporary_path(state, "plain"));
        assert_one_line_with(&error, "Not a directory");
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
    OutputOptions options = make_options(temporary_path(state, "locked/"), 3);
    assert_int_equal(output_create(&output, &options, &error), RESULT_FAILED);
    assert_one_line_with(&error, "Permission denied");
}

// A size limit stands for a full disk: writes end short in the same way.
static void a_full_disk_ends_the_run_with_path_and_reason(void **state)
{
    Error error, again;
    Output *output;
    Image *image;
    OutputOptions options = make_options(temporary_path(state, "full/"), 3);
    struct rlimit limit, small;
    getrlimit(RLIMIT_FSIZE, &limit);
    small = limit;
    small.rlim_cur = 64;
    assert_int_equal(output_create(&output, &options, &error), RESULT_OK);
    setrlimit(RLIMIT_FSIZE, &small);
    Result result = draw_frames(output, 100, &error);
    setrlimit(RLIMIT_FSIZE, &limit);
    assert_int_equal(result, RESULT_FAILED);
    assert_one_line_with(&error, temporary_path(state, "full/frame_0000.png"));
    assert_one_line_with(&error, "File too large");
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
    OutputOptions options = make_options(temporary_path(state, "early/"), 3);
    assert_int_equal(output_create(&output, &options, &error), RESULT_OK);
    assert_int_equal(draw_frames(output, 10, &error), RESULT_OK);
    assert_int_equal(output_acquire(output, &image, &error), RESULT_OK);
    output_destroy(output);
    int count = temporary_count_files(options.target);
    assert_in_range(count, 0, 10);
    for (int frame = 0; frame < count; frame++) {
        char name[40];
        snprintf(name, sizeof name, "early/frame_%04d.png", frame);
        assert_frame(temporary_path(state, name), frame, 3);
    }
    output_destroy(NULL);
}

static void the_pool_lends_no_more_images_than_it_has(void **state)
{
    Error error;
    Output *output;
    const Image *seen[2] = {NULL, NULL};
    OutputOptions options = make_options(temporary_path(state, "pool_%02d.png"), 3);
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
        fill(image, frame);
        assert_int_equal(output_submit(output, frame, image, &error), RESULT_OK);
    }
    assert_int_equal(output_finish(output, &error), RESULT_OK);
    output_destroy(output);
    assert_frame(temporary_path(state, "pool_00.png"), 0, 3);
    assert_frame(temporary_path(state, "pool_19.png"), 19, 3);
}

// Puts a shell script in ffmpeg's place. Returns the PATH to go back to.
static char *replace_ffmpeg(void **state, const char *script)
{
    char *before = strdup(getenv("PATH")), path[2000], text[600];
    mkdir(temporary_path(state, "bin"), 0777);
    snprintf(text, sizeof text, "#!/bin/sh\n%s\n", script);
    if (*script) temporary_write(state, "bin/ffmpeg", text, 0755);
    snprintf(path, sizeof path, "%s%s%s", temporary_path(state, "bin"), *script ? ":" : "",
             *script ? before : "");
    setenv("PATH", path, 1);
    return before;
}

static void restore_path(char *path)
{
    setenv("PATH", path, 1);
    free(path);
}

static void a_missing_ffmpeg_is_found_at_the_start(void **state)
{
    Error error;
    Output *output;
    OutputOptions options = make_options(temporary_path(state, "x.mp4"), 3);
    char *path = replace_ffmpeg(state, "");
    Result result = output_create(&output, &options, &error);
    restore_path(path);
    assert_int_equal(result, RESULT_FAILED);
    assert_null(output);
    assert_one_line_with(&error, "Debian package ffmpeg");
    assert_int_equal(temporary_count_files(temporary_path(state, ".")), 1);
}

static void a_dying_ffmpeg_fails_with_its_last_words_and_no_file(void **state)
{
    static const struct {
        const char *script, *part;
    } cases[] = {
        {"head -c 1000 >/dev/null; echo first >&2; echo 'no such codec' >&2; exit 3",
         "status 3: no such codec"},
        {"exit 1", "status 1"},
        {"head -c 3000 >/dev/null; kill -KILL $$", "Killed"},
        {"cat >/dev/null; exit 7", "status 7"},
        {"exec <&-; exit 0", "stopped reading"},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        Error error = {{0}};
        OutputOptions options = make_options(temporary_path(state, "x.mp4"), 3);
        // Larger than the pipe, so that no write ends before ffmpeg has.
        options.width = options.height = 1024;
        char *path = replace_ffmpeg(state, cases[i].script);
        Result result = write_all(&options, 5, &error);
        restore_path(path);
        assert_int_equal(result, RESULT_FAILED);
        assert_one_line_with(&error, temporary_path(state, "x.mp4"));
        assert_one_line_with(&error, cases[i].part);
        assert_int_equal(temporary_count_files(temporary_path(state, ".")), 1);
    }
}

static void destroying_a_video_early_leaves_nothing(void **state)
{
    Error error;
    Output *output;
    OutputOptions options = make_options(temporary_path(state, "x.webm"), 3);
    options.width = options.height = 1024;
    char *path = replace_ffmpeg(state, "exec sleep 600");
    assert_int_equal(output_create(&output, &options, &error), RESULT_OK);
    restore_path(path);
    // The worker hangs in a full pipe with the first frame and has the second one before it.
    assert_int_equal(draw_frames(output, 2, &error), RESULT_OK);
    assert_int_equal(temporary_count_files(temporary_path(state, ".")), 2);
    output_destroy(output);
    assert_int_equal(temporary_count_files(temporary_path(state, ".")), 1);
}

static void a_video_without_frames_is_an_error(void **state)
{
    Error error;
    OutputOptions options = make_options(temporary_path(state, "x.mp4"), 3);
    char *path = replace_ffmpeg(state, "cat >/dev/null");
    Result result = write_all(&options, 0, &error);
    restore_path(path);
    assert_int_equal(result, RESULT_FAILED);
    assert_one_line_with(&error, "at least one frame");
    assert_int_equal(temporary_count_files(temporary_path(state, ".")), 1);
}

// In a process of its own, since an interrupt is for ever. ffmpeg never reads, so only the signal
// can end the wait.
static int wait_for_interrupt(const OutputOptions *options)
{
    Error error;
    Output *output;
    interrupt_install();
    if (output_create(&output, options, &error) != RESULT_OK) return 1;
    if (interrupt_requested()) return 2;
    struct itimerval timer = {.it_value = {.tv_usec = 50000}};
    signal(SIGALRM, SIG_DFL);
    struct sigaction as_interrupt;
    sigaction(SIGTERM, NULL, &as_interrupt);
    sigaction(SIGALRM, &as_interrupt, NULL);
    setitimer(ITIMER_REAL, &timer, NULL);
    if (draw_frames(output, 100, &error) != RESULT_INTERRUPTED) return 3;
    if (!interrupt_requested()) return 4;
    if (output_finish(output, &error) != RESULT_INTERRUPTED) return 5;
    output_destroy(output);
    return 0;
}

static void an_interrupt_ends_a_wait_and_leaves_nothing(void **state)
{
    OutputOptions options = make_options(temporary_path(state, "x.mp4"), 3);
    options.width = options.height = 1024;
    char *path = replace_ffmpeg(state, "exec sleep 600");
    pid_t child = fork();
    if (child == 0) _exit(wait_for_interrupt(&options));
    int status;
    assert_int_equal(waitpid(child, &status, 0), child);
    restore_path(path);
    assert_true(WIFEXITED(status));
    assert_int_equal(WEXITSTATUS(status), 0);
    assert_int_equal(temporary_count_files(temporary_path(state, ".")), 1);
}

static void a_second_interrupt_ends_the_program(void **state)
{
    (void)state;
    pid_t child = fork();
    if (child == 0) {
        interrupt_install();
        raise(SIGINT);
        if (!interrupt_requested()) _exit(1);
        raise(SIGTERM);
        _exit(2);
    }
    int status;
    assert_int_equal(waitpid(child, &status, 0), child);
    assert_true(WIFSIGNALED(status));
    assert_int_equal(WTERMSIG(status), SIGTERM);
}

// Tiles lie as one reads; what is left over is black. Every byte is looked at.
static void a_contact_sheet_holds_its_frames_in_order(void **state)
{
    enum { COLUMNS = 3, ROWS = 2, FRAMES = 5 };
    Error error;
    Image image;
    const char *path = temporary_path(state, "new/sheet.png");
    OutputOptions options = make_options(path, 3);
    options.columns = COLUMNS, options.rows = ROWS, options.frame_count = FRAMES;
    assert_int_equal(write_all(&options, FRAMES, &error), RESULT_OK);
    assert_int_equal(temporary_count_files(temporary_path(state, "new")), 1);
    assert_int_equal(png_read(&image, path, &error), RESULT_OK);
    assert_true(image.width == COLUMNS * WIDTH && image.height == ROWS * HEIGHT);
    for (int y = 0; y < image.height; y++)
        for (int x = 0; x < image.width; x++) {
            int tile = y / HEIGHT * COLUMNS + x / WIDTH;
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
        OutputOptions options = make_options(temporary_path(state, names[i]), 3);
        options.columns = 2, options.rows = 1;
        assert_int_equal(write_all(&options, 1, &error), RESULT_USAGE);
        assert_one_line_with(&error, "contact sheet");
    }
    OutputOptions options = make_options(temporary_path(state, "x.png"), 4);
    options.columns = options.rows = 1000;
    assert_int_equal(write_all(&options, 1, &error), RESULT_USAGE);
    assert_one_line_with(&error, "1 GiB");
    assert_int_equal(temporary_count_files(temporary_path(state, ".")), 0);
}

static void destroying_a_contact_sheet_early_leaves_nothing(void **state)
{
    Error error;
    Output *output;
    OutputOptions options = make_options(temporary_path(state, "sheet.png"), 3);
    options.columns = options.rows = 2;
    assert_int_equal(output_create(&output, &options, &error), RESULT_OK);
    assert_int_equal(draw_frames(output, 3, &error), RESULT_OK);
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
        TEST(a_missing_ffmpeg_is_found_at_the_start),
        TEST(a_dying_ffmpeg_fails_with_its_last_words_and_no_file),
        TEST(destroying_a_video_early_leaves_nothing),
        TEST(a_video_without_frames_is_an_error),
        TEST(a_contact_sheet_holds_its_frames_in_order),
        TEST(a_contact_sheet_is_one_picture_of_less_than_1_gib),
        TEST(destroying_a_contact_sheet_early_leaves_nothing),
        TEST(an_interrupt_ends_a_wait_and_leaves_nothing),
        TEST(a_second_interrupt_ends_the_program),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
