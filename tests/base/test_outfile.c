// SPDX-License-Identifier: MIT
// Output files appear complete or not at all.
#include "base/bytes.h"
#include "base/outfile.h"
#include "support/temporary.h"

#include <fcntl.h>
#include <linux/capability.h>
#include <setjmp.h>
#include <signal.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <sys/sysmacros.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cmocka.h>

static void assert_content(const char *path, const char *expected)
{
    Bytes bytes;
    Error error;
    assert_int_equal(bytes_read_file(&bytes, path, &error), RESULT_OK);
    assert_int_equal(bytes.size, strlen(expected));
    assert_string_equal((const char *)bytes.data, expected);
    bytes_destroy(&bytes);
}

static Result write_text(const char *path, const char *text, Error *error)
{
    Bytes bytes = {.data = (uint8_t *)text, .size = strlen(text)};
    return bytes_write_file(&bytes, path, error);
}

static void what_was_written_is_read_with_a_zero_behind_it(void **state)
{
    Error error;
    const char *path = temporary_path(state, "text");
    assert_int_equal(write_text(path, "two\nlines\n", &error), RESULT_OK);
    assert_content(path, "two\nlines\n");
    assert_int_equal(write_text(path, "", &error), RESULT_OK);
    assert_content(path, "");
}

static void a_missing_file_and_a_folder_are_bad_input(void **state)
{
    Bytes bytes;
    Error error;
    const char *missing = temporary_path(state, "missing");
    assert_int_equal(bytes_read_file(&bytes, missing, &error), RESULT_BAD_INPUT);
    assert_non_null(strstr(error.text, missing));
    assert_non_null(strstr(error.text, "No such file"));
    assert_null(bytes.data);
    assert_int_equal(bytes_read_file(&bytes, temporary_path(state, "."), &error), RESULT_BAD_INPUT);
    assert_non_null(strstr(error.text, "Is a directory"));
    bytes_destroy(&bytes);
}

static void a_pipe_of_unknown_size_is_read_to_its_end(void **state)
{
    (void)state;
    enum { SIZE = 50000 };
    int ends[2];
    assert_int_equal(pipe(ends), 0);
    uint8_t *sent = malloc(SIZE);
    for (int i = 0; i < SIZE; i++) sent[i] = (uint8_t)(i * 7 + i / 256);
    assert_int_equal(write(ends[1], sent, SIZE), SIZE);
    close(ends[1]);
    char path[64];
    snprintf(path, sizeof path, "/dev/fd/%d", ends[0]);
    Bytes bytes;
    Error error;
    assert_int_equal(bytes_read_file(&bytes, path, &error), RESULT_BAD_INPUT);
    assert_non_null(strstr(error.text, "is a device or pipe: expected a plain file"));
    bytes_set_command_line(2, (char *const[]){"test", path});
    assert_int_equal(bytes_read_file(&bytes, path, &error), RESULT_OK);
    bytes_set_command_line(0, NULL);
    assert_int_equal(bytes.size, SIZE);
    assert_memory_equal(bytes.data, sent, SIZE);
    assert_int_equal(bytes.data[SIZE], 0);
    bytes_destroy(&bytes);
    close(ends[0]);
    free(sent);
}

static void a_file_appears_only_when_committed(void **state)
{
    OutFile file;
    Error error;
    const char *path = temporary_path(state, "late");
    assert_int_equal(outfile_open(&file, path, &error), RESULT_OK);
    fputs("complete", file.stream);
    assert_false(temporary_has(state, "late"));
    assert_int_equal(outfile_commit(&file, &error), RESULT_OK);
    assert_content(path, "complete");
    assert_int_equal(temporary_count_files(temporary_path(state, ".")), 1);
    outfile_discard(&file);
    assert_true(temporary_has(state, "late"));
}

static void a_discarded_file_leaves_the_older_one(void **state)
{
    OutFile file;
    Error error;
    const char *path = temporary_path(state, "old");
    assert_int_equal(write_text(path, "old", &error), RESULT_OK);
    assert_int_equal(outfile_open(&file, path, &error), RESULT_OK);
    fputs("new", file.stream);
    outfile_discard(&file);
    outfile_discard(&file);
    assert_content(path, "old");
    assert_int_equal(temporary_count_files(temporary_path(state, ".")), 1);
}

static void a_file_that_exceeds_the_limit_leaves_the_older_one(void **state)
{
    Error error;
    const char *path = temporary_path(state, "limited");
    assert_int_equal(write_text(path, "old", &error), RESULT_OK);
    static char text[200001];
    memset(text, 'x', sizeof text - 1);
    struct rlimit limit, small;
    getrlimit(RLIMIT_FSIZE, &limit);
    small = limit;
    small.rlim_cur = 100000;
    signal(SIGXFSZ, SIG_IGN);
    setrlimit(RLIMIT_FSIZE, &small);
    Result result = write_text(path, text, &error);
    setrlimit(RLIMIT_FSIZE, &limit);
    assert_int_equal(result, RESULT_FAILED);
    assert_non_null(strstr(error.text, path));
    assert_non_null(strstr(error.text, "File too large"));
    assert_null(strchr(error.text, '\n'));
    assert_content(path, "old");
    assert_int_equal(temporary_count_files(temporary_path(state, ".")), 1);
}

// A device that is always full. As root the test makes its own, so that a mistake can't destroy the
// machine's /dev/full.
static const char *find_full_device(void **state)
{
    if (geteuid() != 0) return access("/dev/full", W_OK) == 0 ? "/dev/full" : NULL;
    const char *path = temporary_path(state, "full");
    if (mknod(path, S_IFCHR | 0600, makedev(1, 7)) != 0) return NULL;
    int descriptor = open(path, O_WRONLY);
    if (descriptor < 0) return NULL;
    close(descriptor);
    return path;
}

static void a_full_device_is_reported_and_stays_a_device(void **state)
{
    Error error;
    struct stat status;
    const char *path = find_full_device(state);
    if (!path) {
        puts("skipped: no device that is always full can be had here");
        skip();
    }
    assert_int_equal(write_text(path, "text", &error), RESULT_FAILED);
    assert_non_null(strstr(error.text, path));
    assert_non_null(strstr(error.text, "No space left on device"));
    assert_int_equal(stat(path, &status), 0);
    assert_true(S_ISCHR(status.st_mode));
}

static void a_pipe_is_written_directly(void **state)
{
    Error error;
    struct stat status;
    char text[9] = "";
    const char *path = temporary_path(state, "pipe");
    assert_int_equal(mkfifo(path, 0600), 0);
    int reader = open(path, O_RDWR);
    assert_true(reader >= 0);
    assert_int_equal(write_text(path, "straight", &error), RESULT_OK);
    assert_int_equal(read(reader, text, 8), 8);
    assert_string_equal(text, "straight");
    assert_int_equal(stat(path, &status), 0);
    assert_true(S_ISFIFO(status.st_mode));
    close(reader);
}

static void a_link_is_followed_not_replaced(void **state)
{
    Error error;
    struct stat status;
    const char *target = temporary_path(state, "target"), *link = temporary_path(state, "link");
    assert_int_equal(write_text(target, "old", &error), RESULT_OK);
    assert_int_equal(symlink("target", link), 0);
    assert_int_equal(write_text(link, "new", &error), RESULT_OK);
    assert_content(target, "new");
    assert_int_equal(lstat(link, &status), 0);
    assert_true(S_ISLNK(status.st_mode));
}

static void permissions_follow_the_umask(void **state)
{
    Error error;
    struct stat status;
    mode_t before = umask(027);
    assert_int_equal(write_text(temporary_path(state, "masked"), "x", &error), RESULT_OK);
    umask(before);
    assert_int_equal(stat(temporary_path(state, "masked"), &status), 0);
    assert_int_equal(status.st_mode & 0777, 0640);
}

static void places_where_no_file_can_be_are_named(void **state)
{
    OutFile file;
    Error error;
    temporary_write(state, "plain", "x", 0644);
    const char *paths[] = {temporary_path(state, "plain/below"), temporary_path(state, ".")};
    const char *reasons[] = {"Not a directory", "Is a directory"};
    for (int i = 0; i < 2; i++) {
        assert_int_equal(outfile_open(&file, paths[i], &error), RESULT_FAILED);
        assert_non_null(strstr(error.text, paths[i]));
        assert_non_null(strstr(error.text, reasons[i]));
        outfile_discard(&file);
    }
}

static void missing_folders_are_made(void **state)
{
    Error error;
    char path[300];
    snprintf(path, sizeof path, "%s", temporary_path(state, "a//b/c"));
    assert_int_equal(write_text(path, "x", &error), RESULT_OK);
    assert_content(path, "x");
}

// Drops the privileges of root that other users lack; false if that is not allowed here.
static bool drop_powers(void)
{
    struct __user_cap_header_struct head = {.version = _LINUX_CAPABILITY_VERSION_3};
    const struct __user_cap_data_struct none[_LINUX_CAPABILITY_U32S_3] = {{0}};
    return syscall(SYS_capset, &head, none) == 0;
}

// Runs in a process of its own without root's privileges.
static void a_read_only_file_is_not_replaced(void **state)
{
    enum { REFUSED, REPLACED, NOT_SAID, POWERFUL };
    temporary_write(state, "locked", "old", 0444);
    const char *path = temporary_path(state, "locked");
    int status = 0;
    fflush(stdout);
    pid_t child = fork();
    assert_true(child >= 0);
    if (child == 0) {
        Error error;
        if (!drop_powers()) _exit(POWERFUL);
        if (write_text(path, "new", &error) != RESULT_FAILED) _exit(REPLACED);
        _exit(strstr(error.text, "Permission denied") ? REFUSED : NOT_SAID);
    }
    assert_int_equal(waitpid(child, &status, 0), child);
    if (WIFEXITED(status) && WEXITSTATUS(status) == POWERFUL) {
        puts("skipped: root cannot give up its powers here, and may write read-only files");
        skip();
    }
    assert_int_equal(status, 0);
    assert_content(path, "old");
}

// Some file systems report lost bytes only when the file is closed. Here the descriptor is invalid
// at closing.
static void errors_at_closing_are_reported(void **state)
{
    OutFile file;
    Error error;
    const char *path = temporary_path(state, "pipe");
    assert_int_equal(mkfifo(path, 0600), 0);
    int reader = open(path, O_RDWR);
    assert_true(reader >= 0);
    assert_int_equal(outfile_open(&file, path, &error), RESULT_OK);
    close(fileno(file.stream));
    assert_int_equal(outfile_commit(&file, &error), RESULT_FAILED);
    assert_non_null(strstr(error.text, "Bad file descriptor"));
    close(reader);
}

static void two_writers_of_one_name_do_not_mix(void **state)
{
    OutFile first, second;
    Error error;
    const char *path = temporary_path(state, "shared");
    assert_int_equal(outfile_open(&first, path, &error), RESULT_OK);
    assert_int_equal(outfile_open(&second, path, &error), RESULT_OK);
    fputs("first", first.stream);
    fputs("second", second.stream);
    assert_int_equal(outfile_commit(&second, &error), RESULT_OK);
    assert_content(path, "second");
    assert_int_equal(outfile_commit(&first, &error), RESULT_OK);
    assert_content(path, "first");
}

#define TEST(name) cmocka_unit_test_setup_teardown(name, temporary_create, temporary_destroy)

int main(void)
{
    const struct CMUnitTest tests[] = {
        TEST(what_was_written_is_read_with_a_zero_behind_it),
        TEST(a_missing_file_and_a_folder_are_bad_input),
        TEST(a_pipe_of_unknown_size_is_read_to_its_end),
        TEST(a_file_appears_only_when_committed),
        TEST(a_discarded_file_leaves_the_older_one),
        TEST(a_file_that_exceeds_the_limit_leaves_the_older_one),
        TEST(a_full_device_is_reported_and_stays_a_device),
        TEST(a_pipe_is_written_directly),
        TEST(a_link_is_followed_not_replaced),
        TEST(permissions_follow_the_umask),
        TEST(places_where_no_file_can_be_are_named),
        TEST(missing_folders_are_made),
        TEST(a_read_only_file_is_not_replaced),
        TEST(errors_at_closing_are_reported),
        TEST(two_writers_of_one_name_do_not_mix),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
