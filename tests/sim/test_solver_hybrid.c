// SPDX-License-Identifier: MIT
// Hybrid on the GPU against its double-precision form. What it shares with others that converge is
// in test_solvers_convergent.c.
#include "support/reference_hybrid.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stdlib.h>

#include <cmocka.h>

static const TwinPair PAIR = {"hybrid", "", reference_hybrid_step, false};

// Measured: at most 1.6e-6 of the length over 600 steps (2 particles), 8e-7 for 16 and 32. 10 times
// that.
static void it_equals_its_double_precision_twin(void **state)
{
    (void)state;
    static const TwinCase cases[] = {
        {2, 60, 1, 0, 600, 2e-5, NULL},   {3, 60, 4, 0, 600, 1e-5, NULL},
        {16, 60, 4, 0, 60, 1e-5, NULL},   {16, 240, 4, 0, 600, 1e-5, NULL},
        {16, 60, 4, 0.5, 60, 1e-5, NULL}, {16, 60, 4, 0.99, 60, 1e-5, NULL},
        {16, 60, 0, 0, 30, 1e-5, NULL},   {32, 60, 4, 0, 30, 1e-5, NULL},
    };
    twin_require(&PAIR, cases, sizeof cases / sizeof *cases);
}

static void strands_through_memory_equal_the_twin_too(void **state)
{
    (void)state;
    static const TwinCase cases[] = {
        {33, 60, 4, 0, 30, 1e-5, NULL},
        {64, 60, 4, 0.5, 8, 1e-5, NULL},
    };
    twin_require(&PAIR, cases, sizeof cases / sizeof *cases);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(it_equals_its_double_precision_twin),
        cmocka_unit_test(strands_through_memory_equal_the_twin_too),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
