// SPDX-License-Identifier: MIT
// The GLSL tractrix against test vectors of high precision, and the judge of such vectors.
#include "bench/test_vectors.h"
#include "support/hair_fixture.h"
#include "support/temporary.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

static void every_step_is_within_16_floors_of_the_exact_curve(void **state)
{
    (void)state;
    TestVectorsReport report = {0};
    Error error;
    if (test_vectors_check_steps(&report, fixture_gpu(), VECTORS_OURS,
                                 "tests/data/tractrix_steps.csv", &error))
        fail_msg("%s", error.text);
    assert_int_equal(report.rows, 2000);
    assert_int_equal(report.failed, 0);
}

static void every_chain_is_within_32_sensitivities(void **state)
{
    (void)state;
    TestVectorsReport report = {0};
    Error error;
    if (test_vectors_check_chains(&report, fixture_gpu(), "tests/data/chain_pulls.csv", &error))
        fail_msg("%s", error.text);
    assert_int_equal(report.rows, 100);
    assert_int_equal(report.failed, 0);
}

static const char *write_vectors(void **state, const char *text)
{
    const char *path = temporary_path(state, "vectors.csv");
    FILE *file = fopen(path, "w");
    assert_non_null(file);
    fputs(text, file);
    fclose(file);
    return path;
}

static const char HEADER[] = "id,category,hx_hex,hy_hex,hz_hex,tx_hex,ty_hex,tz_hex,px_hex,py_hex,"
                             "pz_hex,floor32,tnx,tny,tnz\n";

static void a_wrong_answer_fails(void **state)
{
    char text[1024];
    TestVectorsReport report = {0};
    Error error;
    // The strand is pulled along itself by 0.5: the tail moves from (1,0,0) to (0.5,0,0). The
    // second row expects 2e-6 more, 20 times the floor.
    snprintf(text, sizeof text, "%s%s%s", HEADER, "0,pull,0,0,0,1,0,0,-0.5,0,0,1e-7,0.5,0,0\n",
             "1,pull,0,0,0,1,0,0,-0.5,0,0,1e-7,0.500002,0,0\n");
    assert_int_equal(test_vectors_check_steps(&report, fixture_gpu(), VECTORS_OURS,
                                              write_vectors(state, text), &error),
                     RESULT_OK);
    assert_int_equal(report.rows, 2);
    assert_int_equal(report.failed, 1);
    assert_int_equal(report.categories[0].worst_id, 1);
}

// The published step, which is measured beside ours, is implemented correctly: it is right for a
// towed tail (0) and a pushed tail (1), wrong where the head passes the tail that it pushes, s >
// 2aL (2), and NaN for a tail beside the head whose distance rounds to more than the length (3).
static void the_published_step_errs_where_it_is_known_to(void **state)
{
    char text[1024];
    TestVectorsReport report = {0};
    Error error;
    snprintf(text, sizeof text, "%s%s%s%s", HEADER,
             "0,towed,0,0,0,-0.8,0.6,0,0.5,0,0,1e-7,-0.421459416072,0.388474699583,0\n",
             "1,pushed,0,0,0,0.8,0.6,0,0.5,0,0,1e-7,1.03606137375,0.844179039812,0\n",
             "2,passed,0,0,0,0.8,0.6,0,2,0,0,1e-7,1.28302709691,0.697101071519,0\n");
    assert_int_equal(test_vectors_check_steps(&report, fixture_gpu(), VECTORS_PUBLISHED,
                                              write_vectors(state, text), &error),
                     RESULT_OK);
    assert_true(report.categories[0].worst < VECTORS_STEP_MARK);
    assert_true(report.categories[1].worst < VECTORS_STEP_MARK);
    assert_true(report.categories[2].worst > 1e6);
}

static void a_bad_field_is_named_by_line_and_column(void **state)
{
    char text[1024];
    TestVectorsReport report = {0};
    Error error;
    snprintf(text, sizeof text, "%s%s", HEADER, "0,pull,0,0,zero,1,0,0,-0.5,0,0,1e-7,0.5,0,0\n");
    assert_int_equal(test_vectors_check_steps(&report, fixture_gpu(), VECTORS_OURS,
                                              write_vectors(state, text), &error),
                     RESULT_BAD_INPUT);
    assert_non_null(strstr(error.text, "vectors.csv:2: hz_hex: got 'zero', expected a number"));
    assert_int_equal(test_vectors_check_steps(&report, fixture_gpu(), VECTORS_OURS,
                                              write_vectors(state, "a,b\n1\n"), &error),
                     RESULT_BAD_INPUT);
    assert_non_null(strstr(error.text, "vectors.csv:2: 1 fields: expected 2, as in the header"));
    assert_int_equal(test_vectors_check_steps(&report, fixture_gpu(), VECTORS_OURS,
                                              write_vectors(state, "a,b\n1,2\n"), &error),
                     RESULT_BAD_INPUT);
    assert_non_null(strstr(error.text, "no column 'hx_hex'"));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_step_is_within_16_floors_of_the_exact_curve),
        cmocka_unit_test(every_chain_is_within_32_sensitivities),
        cmocka_unit_test_setup_teardown(a_wrong_answer_fails, temporary_create, temporary_destroy),
        cmocka_unit_test_setup_teardown(the_published_step_errs_where_it_is_known_to,
                                        temporary_create, temporary_destroy),
        cmocka_unit_test_setup_teardown(a_bad_field_is_named_by_line_and_column, temporary_create,
                                        temporary_destroy),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
