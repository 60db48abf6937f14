// SPDX-License-Identifier: MIT
// No output of a run may be one of its inputs or another output.
#include "base/paths.h"
#include "support/temporary.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cmocka.h>

// Checks a written path against another one.
static Result check(const char *path, const char *other, PathRole role)
{
    Error error = {{0}};
    const PathUse uses[] = {{"--cache", path, PATH_TARGET, NULL}, {"the other", other, role, NULL}};
    Result result = paths_check(uses, 2, &error);
    if (result == RESULT_USAGE) {
        assert_non_null(strstr(error.text, "--cache"));
        assert_non_null(strstr(error.text, "the other"));
    }
    return result;
}

static void assert_one(const char *a, const char *b)
{
    assert_int_equal(check(a, b, PATH_TARGET), RESULT_USAGE);
    assert_int_equal(check(b, a, PATH_TARGET), RESULT_USAGE);
}

static void assert_two(const char *a, const char *b)
{
    assert_int_equal(check(a, b, PATH_TARGET), RESULT_OK);
    assert_int_equal(check(b, a, PATH_TARGET), RESULT_OK);
}

static void an_input_is_not_overwritten_by_any_of_its_names(void **state)
{
    temporary_write(state, "own.tfx", "hair", 0644);
    temporary_write(state, "b.tfx", "hair", 0644);
    assert_int_equal(mkdir(temporary_path(state, "in"), 0755), 0);
    const char *own = temporary_path(state, "own.tfx");
    const char *link_path = temporary_path(state, "link.tfx"),
               *hard = temporary_path(state, "hard");
    assert_int_equal(symlink(own, link_path), 0);
    assert_int_equal(link(own, hard), 0);
    const char *names[] = {own, link_path, hard, temporary_path(state, "in/../own.tfx"),
                           temporary_path(state, ".//own.tfx")};
    for (size_t i = 0; i < sizeof names / sizeof *names; ++i)
        assert_int_equal(check(names[i], own, PATH_READ), RESULT_USAGE);
    assert_int_equal(check(temporary_path(state, "b.tfx"), own, PATH_READ), RESULT_OK);
    assert_int_equal(check(temporary_path(state, "OWN.tfx"), own, PATH_READ), RESULT_OK);
}

static void two_outputs_are_two_files(void **state)
{
    const char *a = temporary_path(state, "x.usda"), *b = temporary_path(state, "y.usda");
    assert_one(a, a);
    assert_one(a, temporary_path(state, "./x.usda"));
    assert_one(a, temporary_path(state, "X.usda")); // equal on file systems that ignore case
    assert_one(temporary_path(state, "new/deep/x"), temporary_path(state, "new/deep/x"));
    assert_two(a, b);
    assert_two(temporary_path(state, "new/x"), temporary_path(state, "old/x"));
}

static void a_pattern_has_all_numbers(void **state)
{
    char pattern[300]; // the results of temporary_path are overwritten by later calls
    snprintf(pattern, sizeof pattern, "%s", temporary_path(state, "e_%d.png"));
    assert_one(pattern, temporary_path(state, "e_0.png"));
    assert_one(pattern, temporary_path(state, "e_0012.png"));
    assert_one(pattern, temporary_path(state, "e_%04d.png"));
    assert_one(pattern, temporary_path(state, "e_1%d.png"));
    assert_one(temporary_path(state, "new/"), temporary_path(state, "new/frame_0003.png"));
    assert_two(pattern, temporary_path(state, "e_.png"));
    assert_two(pattern, temporary_path(state, "e_0.json"));
    assert_two(pattern, temporary_path(state, "e_%d.tfx"));
    assert_two(pattern, temporary_path(state, "in/e_0.png"));
    assert_int_equal(check(pattern, temporary_path(state, "e_7.png"), PATH_READ), RESULT_USAGE);
}

static void a_folder_of_inputs_takes_no_outputs(void **state)
{
    assert_int_equal(mkdir(temporary_path(state, "in"), 0755), 0);
    const char *in = temporary_path(state, "in");
    assert_int_equal(check(temporary_path(state, "in/"), in, PATH_READ), RESULT_USAGE);
    assert_int_equal(check(in, in, PATH_READ), RESULT_USAGE);
    assert_int_equal(check(temporary_path(state, "in/x_%d.png"), in, PATH_READ), RESULT_USAGE);
    assert_int_equal(check(temporary_path(state, "in/x.json"), in, PATH_READ), RESULT_OK);
    assert_int_equal(check(temporary_path(state, "out/"), in, PATH_READ), RESULT_OK);
    const char *pattern = temporary_path(state, "in/x_%04d.tfx");
    assert_int_equal(check(pattern, pattern, PATH_READ), RESULT_USAGE);
    assert_int_equal(check(temporary_path(state, "in/x_0001.tfx"), pattern, PATH_READ),
                     RESULT_USAGE);
}

static void devices_and_streams_may_be_used_twice(void **state)
{
    (void)state;
    assert_two("/dev/null", "/dev/null");
    assert_two("-", "-");
    assert_two("", "");
    assert_int_equal(check(NULL, NULL, PATH_READ), RESULT_OK);
}

static void a_place_that_cannot_be_written_is_told_before_anything_runs(void **state)
{
    Error error;
    temporary_write(state, "plain", "x", 0644);
    PathUse use = {"--cache", temporary_path(state, "plain/x.cache"), PATH_TARGET, NULL};
    assert_int_equal(paths_check(&use, 1, &error), RESULT_FAILED);
    assert_non_null(strstr(error.text, "--cache"));
    assert_non_null(strstr(error.text, "Not a directory"));
    use.path = temporary_path(state, "plain/deep/x_%d.png");
    assert_int_equal(paths_check(&use, 1, &error), RESULT_FAILED);
    use.path = temporary_path(state, "new/deep/x.cache");
    assert_int_equal(paths_check(&use, 1, &error), RESULT_OK);
    use = (PathUse){"the hair file", temporary_path(state, "plain/x.tfx"), PATH_READ, NULL};
    assert_int_equal(paths_check(&use, 1, &error), RESULT_OK);
}

static void a_locked_file_or_folder_is_told_before_anything_runs(void **state)
{
    if (geteuid() == 0) {
        puts("skipped: root may write everywhere");
        skip();
    }
    Error error;
    temporary_write(state, "locked", "x", 0444);
    PathUse use = {"--cache", temporary_path(state, "locked"), PATH_TARGET, NULL};
    assert_int_equal(paths_check(&use, 1, &error), RESULT_FAILED);
    assert_non_null(strstr(error.text, "Permission denied"));
    assert_int_equal(mkdir(temporary_path(state, "shut"), 0555), 0);
    use.path = temporary_path(state, "shut/new/x.cache");
    assert_int_equal(paths_check(&use, 1, &error), RESULT_FAILED);
    assert_non_null(strstr(error.text, "Permission denied"));
}

#define TEST(name) cmocka_unit_test_setup_teardown(name, temporary_create, temporary_destroy)

int main(void)
{
    const struct CMUnitTest tests[] = {
        TEST(an_input_is_not_overwritten_by_any_of_its_names),
        TEST(two_outputs_are_two_files),
        TEST(a_pattern_has_all_numbers),
        TEST(a_folder_of_inputs_takes_no_outputs),
        TEST(devices_and_streams_may_be_used_twice),
        TEST(a_place_that_cannot_be_written_is_told_before_anything_runs),
        TEST(a_locked_file_or_folder_is_told_before_anything_runs),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
