// SPDX-License-Identifier: MIT
// The progress line, and the message that names the current activity.
#include "base/activity.h"
#include "base/progress.h"

#include <pty.h>
#include <setjmp.h>
#include <stdarg.h>
#include <string.h>
#include <unistd.h>

#include <cmocka.h>

// A pseudo-terminal: what was drawn can be read at its other end.
typedef struct Terminal {
    int reader;
    FILE *stream;
} Terminal;

static Terminal open_terminal(unsigned short columns)
{
    Terminal terminal;
    int writer;
    struct winsize size = {.ws_row = 24, .ws_col = columns};
    assert_int_equal(openpty(&terminal.reader, &writer, NULL, NULL, &size), 0);
    terminal.stream = fdopen(writer, "w");
    assert_non_null(terminal.stream);
    return terminal;
}

static void close_terminal(Terminal *terminal)
{
    fclose(terminal->stream);
    close(terminal->reader);
}

// Returns what was drawn since the last call. The terminal passes data on with delay, so a mark is
// written to find the end.
static const char *read_terminal(const Terminal *terminal)
{
    static char text[4000];
    size_t length = 0;
    fputc('@', terminal->stream);
    fflush(terminal->stream);
    do {
        ssize_t got = read(terminal->reader, text + length, sizeof text - length);
        assert_true(got > 0);
        length += (size_t)got;
    } while (text[length - 1] != '@');
    text[length - 1] = 0;
    return text;
}

static int count_draws(const char *text)
{
    int count = 0;
    for (; *text; text++) count += *text == '\r';
    return count;
}

static void the_line_fits_any_width(void **state)
{
    (void)state;
    char line[300];
    for (int columns = 1; columns <= 250; columns++) {
        int length = progress_format(line, sizeof line, columns, 99999, 100000, 12.3456);
        assert_int_equal(length, strlen(line));
        assert_true(length < (columns < 40 ? 40 : columns));
        assert_non_null(strstr(line, "99999/100000"));
    }
    progress_format(line, sizeof line, 40, 2147483646, 2147483647, 1e-9);
    assert_true(strlen(line) < 40);
}

static void the_line_says_count_rate_and_time_left(void **state)
{
    (void)state;
    char line[300];
    progress_format(line, sizeof line, 80, 30, 120, 12.0);
    assert_string_equal(line, "30/120 [##########------------------------------] 12/s, 0:08 left");
    progress_format(line, sizeof line, 80, 0, 7300, 1.0);
    assert_non_null(strstr(line, "1/s, 2:01:40 left"));
    progress_format(line, sizeof line, 80, 0, 120, 0.0);
    assert_string_equal(line, "0/120 [----------------------------------------]");
    progress_format(line, sizeof line, 80, 120, 120, 0.0);
    assert_string_equal(line, "120/120 [########################################]");
}

// Counts of strands reach millions and counts of cells thousands of millions.
static void the_bar_is_right_for_large_counts(void **state)
{
    (void)state;
    char line[300];
    progress_format(line, sizeof line, 100, 1000000000, 2000000000, 0.0);
    assert_string_equal(line, "1000000000/2000000000 [####################--------------------]");
}

// A rate that was divided by zero seconds would stay infinite.
static void two_updates_at_one_time_keep_the_rate(void **state)
{
    (void)state;
    Terminal terminal = open_terminal(80);
    Progress progress;
    progress_start_at(&progress, terminal.stream, 3, false, 0.0);
    progress_update_at(&progress, 1, 0.5);
    progress_update_at(&progress, 3, 0.5); // the last one is always drawn
    assert_true(progress.rate == 2.0);     // not a NaN, which assert_float_equal lets pass
    close_terminal(&terminal);
}

static void nothing_is_drawn_where_no_terminal_is(void **state)
{
    (void)state;
    FILE *file = tmpfile();
    Progress progress;
    progress_start(&progress, file, 10, false);
    for (int done = 1; done <= 10; done++) progress_update(&progress, done);
    progress_clear(&progress);
    fflush(file);
    assert_int_equal(ftell(file), 0);
    fclose(file);
}

static void nothing_is_drawn_when_quiet_or_zeroed(void **state)
{
    (void)state;
    Terminal terminal = open_terminal(80);
    Progress quiet, zeroed = {0};
    progress_start(&quiet, terminal.stream, 10, true);
    progress_update(&quiet, 10);
    progress_clear(&quiet);
    progress_update(&zeroed, 10);
    progress_clear(&zeroed);
    assert_string_equal(read_terminal(&terminal), "");
    close_terminal(&terminal);
}

static void it_draws_ten_times_a_second_and_the_last_frame(void **state)
{
    (void)state;
    Terminal terminal = open_terminal(60);
    Progress progress;
    progress_start_at(&progress, terminal.stream, 1000, false, 5.0);
    // 1000 frames within half a second: drawn at the first frame, four times in between, and at the
    // last frame.
    for (int done = 1; done <= 1000; done++)
        progress_update_at(&progress, done, 5.0 + done * 0.0005);
    const char *text = read_terminal(&terminal);
    assert_in_range(count_draws(text), 5, 7);
    assert_non_null(strstr(text, "1000/1000"));
    close_terminal(&terminal);
}

static void the_rate_settles_on_a_new_value(void **state)
{
    (void)state;
    Terminal terminal = open_terminal(80);
    Progress progress;
    progress_start_at(&progress, terminal.stream, 100000, false, 0.0);
    for (int i = 1; i <= 100; i++) progress_update_at(&progress, 10 * i, i);
    assert_float_equal(progress.rate, 10.0, 1e-6);
    // After ten times the smoothing time, e^-10 of the difference is left.
    for (int i = 1; i <= 30; i++) progress_update_at(&progress, 1000 + 20 * i, 100 + i);
    assert_float_equal(progress.rate, 20.0, 10.0 * 5e-5);
    close_terminal(&terminal);
}

static void clearing_leaves_an_empty_line_and_drawing_goes_on(void **state)
{
    (void)state;
    Terminal terminal = open_terminal(80);
    Progress progress;
    progress_start_at(&progress, terminal.stream, 10, false, 0.0);
    progress_update_at(&progress, 1, 1.0);
    size_t drawn = strlen(read_terminal(&terminal)) - 1;
    progress_clear(&progress);
    const char *text = read_terminal(&terminal);
    assert_int_equal(strspn(text + 1, " "), drawn);
    assert_string_equal(text + 1 + drawn, "\r");
    progress_clear(&progress);
    assert_string_equal(read_terminal(&terminal), "");
    progress_update_at(&progress, 2, 1.01);
    assert_non_null(strstr(read_terminal(&terminal), "2/10"));
    close_terminal(&terminal);
}

// Returns what the thread draws within `seconds`.
static const char *watch_terminal(const Terminal *terminal, double seconds)
{
    usleep((useconds_t)(seconds * 1e6));
    return read_terminal(terminal);
}

static void a_silent_second_is_followed_by_what_the_program_is_at(void **state)
{
    (void)state;
    Terminal terminal = open_terminal(80);
    Progress progress;
    activity_start(terminal.stream, false);
    activity_set("reading hair");
    assert_string_equal(watch_terminal(&terminal, 0.3), "");
    assert_non_null(strstr(watch_terminal(&terminal, 1.7), "\rreading hair, "));
    activity_set(NULL);
    assert_null(strstr(read_terminal(&terminal), "reading"));
    activity_set("simulating");
    progress_start(&progress, terminal.stream, 10, false);
    progress_update(&progress, 3);
    assert_non_null(strstr(watch_terminal(&terminal, 2.0), "left simulating, "));
    progress_clear(&progress);
    activity_end();
    const char *text = read_terminal(&terminal);
    assert_int_equal(text[strlen(text) - 1], '\r');
    close_terminal(&terminal);
}

static void no_activity_is_shown_when_quiet_or_on_a_file(void **state)
{
    (void)state;
    Terminal terminal = open_terminal(80);
    FILE *file = tmpfile();
    activity_start(terminal.stream, true);
    activity_start(file, false);
    activity_set("reading hair");
    assert_string_equal(watch_terminal(&terminal, 1.3), "");
    activity_end();
    fflush(file);
    assert_int_equal(ftell(file), 0);
    fclose(file);
    close_terminal(&terminal);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_line_fits_any_width),
        cmocka_unit_test(the_line_says_count_rate_and_time_left),
        cmocka_unit_test(the_bar_is_right_for_large_counts),
        cmocka_unit_test(two_updates_at_one_time_keep_the_rate),
        cmocka_unit_test(nothing_is_drawn_where_no_terminal_is),
        cmocka_unit_test(nothing_is_drawn_when_quiet_or_zeroed),
        cmocka_unit_test(it_draws_ten_times_a_second_and_the_last_frame),
        cmocka_unit_test(the_rate_settles_on_a_new_value),
        cmocka_unit_test(clearing_leaves_an_empty_line_and_drawing_goes_on),
        cmocka_unit_test(a_silent_second_is_followed_by_what_the_program_is_at),
        cmocka_unit_test(no_activity_is_shown_when_quiet_or_on_a_file),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
