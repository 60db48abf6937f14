// SPDX-License-Identifier: MIT
// Videos with scripts that imitate ffmpeg, and interrupts while they are written.
#include "base/interrupt.h"
#include "base/interrupt_install.h"
#include "support/grey_frames.h"
#include "support/temporary.h"

#include <setjmp.h>
#include <signal.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <sys/time.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cmocka.h>

// Puts a shell script in ffmpeg's place. Returns the previous PATH.
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
    OutputOptions options = grey_options(temporary_path(state, "x.mp4"), 3);
    char *path = replace_ffmpeg(state, "");
    Result result = output_create(&output, &options, &error);
    restore_path(path);
    assert_int_equal(result, RESULT_FAILED);
    assert_null(output);
    grey_assert_line(&error, "Debian package ffmpeg");
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
        OutputOptions options = grey_options(temporary_path(state, "x.mp4"), 3);
        // Larger than the pipe, so that no write ends before ffmpeg does.
        options.width = options.height = 1024;
        char *path = replace_ffmpeg(state, cases[i].script);
        Result result = grey_write(&options, 5, &error);
        restore_path(path);
        assert_int_equal(result, RESULT_FAILED);
        grey_assert_line(&error, temporary_path(state, "x.mp4"));
        grey_assert_line(&error, cases[i].part);
        assert_int_equal(temporary_count_files(temporary_path(state, ".")), 1);
    }
}

static void destroying_a_video_early_leaves_nothing(void **state)
{
    Error error;
    Output *output;
    OutputOptions options = grey_options(temporary_path(state, "x.webm"), 3);
    options.width = options.height = 1024;
    char *path = replace_ffmpeg(state, "exec sleep 600");
    assert_int_equal(output_create(&output, &options, &error), RESULT_OK);
    restore_path(path);
    // The worker waits with the first frame for the full pipe, and the second frame waits for the
    // worker.
    assert_int_equal(grey_draw(output, 2, &error), RESULT_OK);
    assert_int_equal(temporary_count_files(temporary_path(state, ".")), 2);
    output_destroy(output);
    assert_int_equal(temporary_count_files(temporary_path(state, ".")), 1);
}

static void a_video_without_frames_is_an_error(void **state)
{
    Error error;
    OutputOptions options = grey_options(temporary_path(state, "x.mp4"), 3);
    char *path = replace_ffmpeg(state, "cat >/dev/null");
    Result result = grey_write(&options, 0, &error);
    restore_path(path);
    assert_int_equal(result, RESULT_FAILED);
    grey_assert_line(&error, "at least one frame");
    assert_int_equal(temporary_count_files(temporary_path(state, ".")), 1);
}

// Runs in a process of its own, since an interrupt can't be undone. ffmpeg never reads, so that
// only the signal can end the wait.
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
    if (grey_draw(output, 100, &error) != RESULT_INTERRUPTED) return 3;
    if (!interrupt_requested()) return 4;
    if (output_finish(output, &error) != RESULT_INTERRUPTED) return 5;
    output_destroy(output);
    return 0;
}

// The second script has a child process that keeps the pipe open after the script has been killed.
static void an_interrupt_ends_a_wait_and_leaves_nothing(void **state)
{
    static const char *const scripts[] = {"exec sleep 600", "sleep 600; true"};
    OutputOptions options = grey_options(temporary_path(state, "x.mp4"), 3);
    options.width = options.height = 1024;
    for (int i = 0; i < 2; ++i) {
        char *path = replace_ffmpeg(state, scripts[i]);
        pid_t child = fork();
        if (child == 0) _exit(wait_for_interrupt(&options));
        int status;
        assert_int_equal(waitpid(child, &status, 0), child);
        restore_path(path);
        assert_true(WIFEXITED(status));
        assert_int_equal(WEXITSTATUS(status), 0);
        assert_int_equal(temporary_count_files(temporary_path(state, ".")), 1);
    }
}

static void an_ffmpeg_that_writes_nothing_is_an_error(void **state)
{
    OutputOptions options = grey_options(temporary_path(state, "x.mp4"), 3);
    Error error;
    char *path = replace_ffmpeg(state, "cat >/dev/null");
    Result result = grey_write(&options, 3, &error);
    restore_path(path);
    assert_int_equal(result, RESULT_FAILED);
    grey_assert_line(&error, "wrote nothing");
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

#define TEST(name) cmocka_unit_test_setup_teardown(name, temporary_create, temporary_destroy)

int main(void)
{
    const struct CMUnitTest tests[] = {
        TEST(a_missing_ffmpeg_is_found_at_the_start),
        TEST(a_dying_ffmpeg_fails_with_its_last_words_and_no_file),
        TEST(destroying_a_video_early_leaves_nothing),
        TEST(a_video_without_frames_is_an_error),
        TEST(an_ffmpeg_that_writes_nothing_is_an_error),
        TEST(an_interrupt_ends_a_wait_and_leaves_nothing),
        TEST(a_second_interrupt_ends_the_program),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
