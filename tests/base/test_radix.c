// SPDX-License-Identifier: MIT
#include "base/radix.h"
#include "base/random.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

enum { COUNT = 20000 };

static void least_keys_come_first_and_equal_ones_stay_in_order(void **state)
{
    (void)state;
    static uint64_t pairs[COUNT], other[COUNT];
    const uint32_t masks[] = {0xffffffffu, 0xff, 0x7ff << 11, 0xf8000000u, 0};
    Random random = random_create(1, 0);
    for (size_t m = 0; m < sizeof masks / sizeof *masks; ++m) {
        for (size_t i = 0; i < COUNT; ++i)
            pairs[i] =
                (uint64_t)((uint32_t)(random_real(&random) * 4294967295.0) & masks[m]) << 32 | i;
        const uint64_t *sorted = radix_sort(pairs, other, COUNT);
        for (size_t i = 1; i < COUNT; ++i) assert_true(sorted[i - 1] < sorted[i]);
    }
}

static void no_pair_is_lost(void **state)
{
    (void)state;
    static uint64_t pairs[COUNT], other[COUNT];
    static uint8_t seen[COUNT];
    Random random = random_create(2, 0);
    for (size_t i = 0; i < COUNT; ++i)
        pairs[i] = (uint64_t)(uint32_t)(random_real(&random) * 1000) << 32 | i;
    const uint64_t *sorted = radix_sort(pairs, other, COUNT);
    memset(seen, 0, sizeof seen);
    for (size_t i = 0; i < COUNT; ++i) {
        assert_true((uint32_t)sorted[i] < COUNT && !seen[(uint32_t)sorted[i]]);
        seen[(uint32_t)sorted[i]] = 1;
    }
}

static void nothing_is_sorted_to_nothing(void **state)
{
    (void)state;
    uint64_t one = 7, other = 0;
    radix_sort(&one, &other, 0);
    assert_true(one == 7 && other == 0);
    assert_true(*radix_sort(&one, &other, 1) == 7);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(least_keys_come_first_and_equal_ones_stay_in_order),
        cmocka_unit_test(no_pair_is_lost),
        cmocka_unit_test(nothing_is_sorted_to_nothing),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
