// SPDX-License-Identifier: MIT
// The record next to numbered files: it can be read back, and errors of writing it are reported.
#include "run/record.h"

#include "base/bytes.h"
#include "support/temporary.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#include <cmocka.h>

static const char SCENE[] = "0123456789abcdef", OTHER[] = "fedcba9876543210";

// The target x_%d.pfm, of which the file of frame 1 exists.
static Target make_target(void **state, char **frame)
{
    Target target;
    char text[] = "light";
    const Bytes file = {.data = (uint8_t *)text, .size = strlen(text)};
    assert_int_equal(target_parse(&target, temporary_path(state, "x_%d.pfm"), NULL), RESULT_OK);
    *frame = target_name_frame(&target, 1);
    assert_non_null(*frame);
    assert_int_equal(bytes_write_file(&file, *frame, NULL), RESULT_OK);
    return target;
}

static void the_last_line_of_a_frame_counts(void **state)
{
    char *frame;
    Record record;
    Error why;
    Target target = make_target(state, &frame);
    assert_int_equal(record_add(&target, 1, OTHER, NULL), RESULT_OK);
    assert_int_equal(record_add(&target, 1, SCENE, NULL), RESULT_OK);
    assert_int_equal(record_read(&record, &target, 1, NULL), RESULT_OK);
    assert_int_equal(record_compare(&record, 1, frame, SCENE, NULL), RESULT_OK);
    assert_int_equal(record_compare(&record, 1, frame, OTHER, &why), RESULT_FAILED);
    assert_non_null(strstr(why.text, "was made with other parameters or input files"));
    record_destroy(&record);
    target_destroy(&target);
    free(frame);
}

static void a_record_that_cannot_be_written_says_why(void **state)
{
    char *frame;
    Error error;
    Target target = make_target(state, &frame);
    char *path = record_path(&target);
    assert_non_null(path);
    assert_int_equal(mkdir(path, 0777), 0);
    assert_int_equal(record_add(&target, 1, SCENE, &error), RESULT_FAILED);
    assert_non_null(strstr(error.text, path));
    assert_non_null(strstr(error.text, "Is a directory"));
    free(path);
    target_destroy(&target);
    free(frame);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(the_last_line_of_a_frame_counts, temporary_create,
                                        temporary_destroy),
        cmocka_unit_test_setup_teardown(a_record_that_cannot_be_written_says_why, temporary_create,
                                        temporary_destroy),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
