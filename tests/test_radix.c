// SPDX-License-Identifier: MIT
#include "radix.h"
#include "random.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stdlib.h>

#include <cmocka.h>

enum { COUNT = 20000 };

static uint32_t keys[COUNT], order[COUNT];

static size_t sort(size_t count)
{
    Radix radix = {0};
    Error error = {{0}};
    size_t sorted = 0;
    assert_int_equal(radix_sort_descending(&radix, keys, count, order, &sorted, &error), RESULT_OK);
    radix_destroy(&radix);
    return sorted;
}

static void largest_come_first_equal_ones_in_order_and_zeros_not_at_all(void **state)
{
    (void)state;
    const uint32_t masks[] = {0xffffffffu, 0xff, 0x7ff << 11, 0xf8000000u, 0};
    Random random = random_create(1, 0);
    for (size_t m = 0; m < sizeof masks / sizeof *masks; ++m) {
        size_t others = 0;
        for (size_t i = 0; i < COUNT; ++i) {
            keys[i] = (uint32_t)(random_real(&random) * 4294967295.0) & masks[m];
            others += keys[i] != 0;
        }
        assert_int_equal(sort(COUNT), others);
        for (size_t i = 1; i < others; ++i) {
            uint32_t a = keys[order[i - 1]], b = keys[order[i]];
            assert_true(a > b || (a == b && order[i - 1] < order[i]));
        }
    }
}

static void nothing_is_sorted_to_nothing(void **state)
{
    (void)state;
    assert_int_equal(sort(0), 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(largest_come_first_equal_ones_in_order_and_zeros_not_at_all),
        cmocka_unit_test(nothing_is_sorted_to_nothing),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
