// SPDX-License-Identifier: MIT
// Hybrid on the GPU against its double-precision form. Properties shared by all convergent solvers
// are in test_solvers_convergent.c.
#include "support/reference_hybrid.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stdlib.h>

#include <cmocka.h>

static const TwinPair PAIR = {"hybrid", "", reference_hybrid_step, false};

// Bounds are three times the measured values, the larger of a CPU with and without AVX.
static void it_equals_its_double_precision_twin(void **state)
{
    (void)state;
    static const TwinCase cases[] = {
        {2, 60, 1, 0, 600, 3 * 1.7e-6, NULL},   {3, 60, 4, 0, 600, 3 * 4.1e-7, NULL},
        {16, 60, 4, 0, 60, 3 * 1.3e-7, NULL},   {16, 240, 4, 0, 600, 3 * 3.4e-7, NULL},
        {16, 60, 4, 0.5, 60, 3 * 3.2e-7, NULL}, {16, 60, 4, 0.99, 60, 3 * 5.3e-8, NULL},
        {16, 60, 0, 0, 30, 3 * 5.1e-7, NULL},   {32, 60, 4, 0, 30, 3 * 7.9e-7, NULL},
    };
    twin_require(&PAIR, cases, sizeof cases / sizeof *cases);
}

static void strands_through_memory_equal_the_twin_too(void **state)
{
    (void)state;
    static const TwinCase cases[] = {
        {33, 60, 4, 0, 30, 3 * 5.4e-7, NULL},
        {64, 60, 4, 0.5, 8, 3 * 4.9e-7, NULL},
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
