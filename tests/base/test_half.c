// SPDX-License-Identifier: MIT
// Half floats: from one to the next, each number grows by a unit in the last place.
#include "base/half.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>

#include <cmocka.h>

static void every_pattern_has_its_number(void **state)
{
    (void)state;
    enum { INFINITE = 0x7c00, SIGN = 0x8000 };
    double value = 0;
    for (uint32_t bits = 0; bits < INFINITE; ++bits) {
        if (half_number(bits) != value || half_number(bits | SIGN) != -value)
            fail_msg("%#x is %g and %g, not %g", bits, half_number(bits), half_number(bits | SIGN),
                     value);
        assert_true(signbit(half_number(bits | SIGN)) && !signbit(half_number(bits)));
        value += exp2((bits < 2048 ? 1 : bits / 1024) - 25.0);
    }
    assert_true(half_number(0x3c00) == 1 && half_number(INFINITE - 1) == 65504);
    assert_true(half_number(INFINITE) == INFINITY && half_number(INFINITE | SIGN) == -INFINITY);
    for (uint32_t bits = INFINITE + 1; bits < SIGN; ++bits)
        assert_true(isnan(half_number(bits)) && isnan(half_number(bits | SIGN)));
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(every_pattern_has_its_number)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
