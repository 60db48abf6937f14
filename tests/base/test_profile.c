// SPDX-License-Identifier: MIT
// Parameters that vary along a strand.
#include "base/profile.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

static ProfileNumber parse(const char *text)
{
    ProfileNumber number = {0};
    if (!profile_parse(&number, text, 0, 10)) fail_msg("%s is refused", text);
    return number;
}

static float at(const ProfileNumber *number, double share)
{
    return profile_at(number->mean, &number->along, share);
}

static void one_number_is_the_same_everywhere(void **state)
{
    (void)state;
    ProfileNumber number = parse("0.75");
    assert_int_equal(number.along.count, 0);
    assert_true(at(&number, 0) == 0.75f && at(&number, 1) == 0.75f);
}

static void points_are_joined_by_straight_lines(void **state)
{
    (void)state;
    ProfileNumber even = parse("4:2:0"), placed = parse("4:2@0.25:2@0.5:10"),
                  short_one = parse("3@0.5:1@0.75");
    assert_true(at(&even, 0) == 4 && at(&even, 0.25) == 3 && at(&even, 0.5) == 2 &&
                at(&even, 1) == 0);
    assert_true(even.mean == 2);
    assert_true(at(&placed, 0.125) == 3 && at(&placed, 0.4) == 2 && at(&placed, 0.75) == 6);
    assert_true(placed.mean == 0.25f * 3 + 0.25f * 2 + 0.5f * 6);
    assert_true(at(&short_one, 0) == 3 && at(&short_one, 0.625) == 2 && at(&short_one, 1) == 1);
    assert_true(short_one.mean == 0.5f * 3 + 0.25f * 2 + 0.25f * 1);
}

static void text_comes_back_to_the_bit(void **state)
{
    (void)state;
    static const char *const texts[] = {"0.1", "9:0.3", "4:2@0.25:0.7", "3@0.5:1@0.75",
                                        "1:2:3:4:5:6:7:8"};
    for (size_t i = 0; i < sizeof texts / sizeof *texts; ++i) {
        char text[400];
        ProfileNumber number = parse(texts[i]), again;
        profile_format(&number, text, sizeof text);
        again = parse(text);
        assert_memory_equal(&number, &again, sizeof number);
    }
}

static void what_is_no_profile_is_refused(void **state)
{
    (void)state;
    static const char *const texts[] = {
        "",      ":",     "1:",   ":1",          "1::2",        "1@",          "1@0.5",
        "1@2:3", "1:11",  "-1:2", "1@0.5:2@0.5", "1@0.7:2@0.2", "1:2:3@0.5:4", "1:2:3:4:5:6:7:8:9",
        "1;2",   "1:nan", "1:2x", "1@-0.1:2"};
    for (size_t i = 0; i < sizeof texts / sizeof *texts; ++i) {
        ProfileNumber number = {.mean = 5};
        if (profile_parse(&number, texts[i], 0, 10)) fail_msg("'%s' is taken", texts[i]);
        assert_true(number.mean == 5 && number.along.count == 0);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(one_number_is_the_same_everywhere),
        cmocka_unit_test(points_are_joined_by_straight_lines),
        cmocka_unit_test(text_comes_back_to_the_bit),
        cmocka_unit_test(what_is_no_profile_is_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
