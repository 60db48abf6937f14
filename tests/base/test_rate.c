// SPDX-License-Identifier: MIT
#include "base/rate.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

static void rates_are_decimals_or_fractions(void **state)
{
    (void)state;
    static const struct {
        const char *text;
        double rate;
        const char *back;
    } cases[] = {
        {"25", 25, "25"},
        {"23.976", 24000 / 1001.0, "24000/1001"},
        {"23.98", 24000 / 1001.0, "24000/1001"},
        {"23.976024", 24000 / 1001.0, "24000/1001"}, // as a float32 prints
        {"29.97", 30000 / 1001.0, "30000/1001"},
        {"59.94", 60000 / 1001.0, "60000/1001"},
        {"30000/1001", 30000 / 1001.0, "30000/1001"},
        {"1 / 4", 0.25, "0.25"},
        {"23.5", 23.5, "23.5"},
        {"24", 24, "24"},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; ++i) {
        double rate = 0;
        char back[40];
        assert_true(rate_parse(cases[i].text, &rate));
        assert_true(rate == cases[i].rate);
        rate_format(rate, back, sizeof back);
        assert_string_equal(back, cases[i].back);
    }
    static const char *const wrong[] = {"", "x", "1/0", "1/-2", "1/", "1/2/3", "inf", "0x10"};
    for (size_t i = 0; i < sizeof wrong / sizeof *wrong; ++i) {
        double rate = 7;
        assert_false(rate_parse(wrong[i], &rate));
        assert_true(rate == 7);
    }
}

static void fractions_are_reduced(void **state)
{
    (void)state;
    static const struct {
        double rate;
        long numerator, denominator;
    } cases[] = {{25, 25, 1}, {24000 / 1001.0, 24000, 1001}, {12.5, 25, 2}, {0.1, 1, 10}};
    for (size_t i = 0; i < sizeof cases / sizeof *cases; ++i) {
        long numerator, denominator;
        rate_fraction(cases[i].rate, &numerator, &denominator);
        assert_int_equal(numerator, cases[i].numerator);
        assert_int_equal(denominator, cases[i].denominator);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(rates_are_decimals_or_fractions),
                                       cmocka_unit_test(fractions_are_reduced)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
