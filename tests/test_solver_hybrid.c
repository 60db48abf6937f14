// SPDX-License-Identifier: MIT
// Hybrid on the GPU against its double-precision form and the exact motion, and what must hold for
// any hair.
#include "convergent.h"
#include "reference_hybrid.h"
#include "reference_motion.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

// Measured: at most 1.6e-6 of the length over 600 steps (2 particles), 8e-7 for 16 and 32. 10 times
// that.
static void it_equals_its_double_precision_twin(void **state)
{
    (void)state;
    const ConvergentCase cases[] = {
        {2, 60, 1, 0, 600, 2e-5},   {3, 60, 4, 0, 600, 1e-5},   {16, 60, 4, 0, 60, 1e-5},
        {16, 240, 4, 0, 600, 1e-5}, {16, 60, 4, 0.5, 60, 1e-5}, {16, 60, 4, 0.99, 60, 1e-5},
        {16, 60, 0, 0, 30, 1e-5},   {32, 60, 4, 0, 30, 1e-5},
    };
    convergent_equals_twin("hybrid", reference_hybrid_step, cases, sizeof cases / sizeof *cases);
}

static void strands_through_memory_equal_the_twin_too(void **state)
{
    (void)state;
    const ConvergentCase cases[] = {
        {33, 60, 4, 0, 30, 1e-5},
        {64, 60, 4, 0.5, 8, 1e-5},
    };
    convergent_equals_twin("hybrid", reference_hybrid_step, cases, sizeof cases / sizeof *cases);
}

// As its double-precision form: 0.0048, 0.0017 and 0.00015 of the length (second order: 16 from 120
// to 480 Hz, less than that as long as the guard of energy acts), over all scenarios 0.0189, 0.0080
// and 0.0036 at 60, 120 and 240 Hz.
static void its_error_falls_with_the_step(void **state)
{
    (void)state;
    convergent_falls_with_the_step("hybrid", 0.003, 10);
    assert_true(motion_mean_error("hybrid", "", 1, NULL) < 0.02);
    assert_true(motion_mean_error("hybrid", "", 2, NULL) < 0.009);
    assert_true(motion_mean_error("hybrid", "", 4, NULL) < 0.004);
}

static void hanging_hair_stays_at_rest(void **state)
{
    (void)state;
    convergent_stays_at_rest("hybrid");
}

static void lengths_survive_violence(void **state)
{
    (void)state;
    convergent_survives_violence("hybrid");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(it_equals_its_double_precision_twin),
        cmocka_unit_test(strands_through_memory_equal_the_twin_too),
        cmocka_unit_test(its_error_falls_with_the_step),
        cmocka_unit_test(hanging_hair_stays_at_rest),
        cmocka_unit_test(lengths_survive_violence),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
