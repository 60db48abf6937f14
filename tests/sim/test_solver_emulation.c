// SPDX-License-Identifier: MIT
// Emulation on the GPU against its double-precision form and reference traces. Properties shared by
// all convergent solvers are in test_solvers_convergent.c.
#include "support/reference_hybrid.h"
#include "support/reference_traces.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

static const TwinPair PAIR = {"emulation", "", reference_emulation_step, false};

// Bounds are three times the measured values, the larger of a CPU with and without AVX. The pulls
// of long strands amplify rounding.
static void it_equals_its_double_precision_twin(void **state)
{
    (void)state;
    static const TwinCase cases[] = {
        {2, 60, 1, 0, 600, 3 * 1.9e-6, NULL},   {3, 60, 4, 0, 600, 3 * 3.1e-7, NULL},
        {16, 60, 4, 0, 60, 3 * 2.7e-7, NULL},   {16, 240, 4, 0, 120, 3 * 7.1e-7, NULL},
        {16, 60, 4, 0.5, 60, 3 * 2.9e-7, NULL}, {32, 60, 4, 0, 20, 3 * 1.7e-6, NULL},
    };
    twin_require(&PAIR, cases, sizeof cases / sizeof *cases);
}

static void strands_through_memory_equal_the_twin_too(void **state)
{
    (void)state;
    static const TwinCase cases[] = {
        {33, 60, 4, 0, 20, 3 * 1.5e-6, NULL},
        {64, 60, 4, 0.5, 8, 3 * 1.8e-6, NULL},
        {250, 60, 4, 0.5, 3, 3 * 4.1e-6, NULL},
    };
    twin_require(&PAIR, cases, sizeof cases / sizeof *cases);
}

// The published rule amplifies rounding from the first steps on.
static void thesis_equals_its_double_precision_twin(void **state)
{
    (void)state;
    static const TwinPair pair = {"emulation", "thesis", reference_thesis_emulation_step, false};
    static const TwinCase trial = {16, 60, 4, 0.5, 20, 3 * 1.1e-6, NULL};
    twin_require(&pair, &trial, 1);
}

static void thesis_equals_the_reference_traces(void **state)
{
    (void)state;
    assert_int_equal(
        traces_compare("emulation", "emulation", "thesis", traces_imitate_explicit_drag), 4);
}

static void long_strands_are_refused(void **state)
{
    (void)state;
    static float position[5001][3];
    uint32_t first[2] = {0, 5001};
    Strands strands = {
        .strand_count = 1, .vertex_count = 5001, .first = first, .position = position};
    Hair hair;
    Solver solver;
    SectionParams params;
    Error error = {{0}};
    for (int j = 0; j < 5001; ++j) position[j][1] = -0.0001f * (float)j;
    assert_int_equal(params_create_section(&params, &error), RESULT_OK);
    free(params.algo);
    params.algo = strdup("emulation");
    assert_int_equal(hair_create(&hair, &strands, 0, &fixture_gpu()->limits, &error), RESULT_OK);
    const SolverSetup setup = {.gpu = fixture_gpu(), .hair = &hair, .params = &params};
    assert_int_equal(solver_create(&solver, &setup, &error), RESULT_USAGE);
    assert_non_null(strstr(error.text, "5001 vertices: expected at most 5000"));
    hair_destroy(&hair);
    params_destroy_section(&params);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(it_equals_its_double_precision_twin),
        cmocka_unit_test(strands_through_memory_equal_the_twin_too),
        cmocka_unit_test(thesis_equals_its_double_precision_twin),
        cmocka_unit_test(thesis_equals_the_reference_traces),
        cmocka_unit_test(long_strands_are_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
