// SPDX-License-Identifier: MIT
#include "base/stock.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

static int ended; // number of destroyed values
static char last; // the last destroyed value

static void end(void *value)
{
    ++ended;
    last = *(char *)value;
}

static char *add(Stock *stock, const char *key)
{
    char *value = stock_add(stock, key, strlen(key), 1, end);
    assert_non_null(value);
    *value = *key;
    return value;
}

static char *take(Stock *stock, const char *key)
{
    return stock_take(stock, key, strlen(key));
}

static void a_key_finds_its_value_and_no_other(void **state)
{
    Stock stock = {.most = 10};
    (void)state;
    assert_null(take(&stock, "a"));
    char *a = add(&stock, "a"), *longer = add(&stock, "ab");
    assert_ptr_equal(take(&stock, "a"), a);
    assert_ptr_equal(take(&stock, "ab"), longer);
    assert_null(take(&stock, "b"));
    assert_null(take(&stock, ""));
    stock_destroy(&stock, false);
}

static void idle_values_stay_and_the_longest_untaken_goes(void **state)
{
    Stock stock = {.most = 2};
    char *values[] = {add(&stock, "a"), add(&stock, "b"), add(&stock, "c")};
    (void)state;
    ended = 0;
    assert_ptr_equal(take(&stock, "a"),
                     values[0]); // has two users now, and was taken after b and c
    for (int i = 2; i >= 0; --i) stock_return(&stock, values[i]);
    assert_int_equal(ended, 0); // a still has one user
    stock_return(&stock, values[0]);
    assert_int_equal(ended, 1);
    assert_int_equal(last, 'b');
    assert_ptr_equal(take(&stock, "c"), values[2]);
    assert_ptr_equal(take(&stock, "a"), values[0]);
    stock_destroy(&stock, false);
}

static void values_in_use_are_not_counted(void **state)
{
    enum { COUNT = 5 };
    static const char *const keys[COUNT] = {"a", "b", "c", "d", "e"};
    Stock stock = {.most = 1};
    int seen = 0;
    (void)state;
    ended = 0;
    for (int i = 0; i < COUNT; ++i) add(&stock, keys[i]);
    stock_return(&stock, add(&stock, "f"));
    assert_int_equal(ended, 0);
    stock_return(&stock, add(&stock, "g"));
    assert_int_equal(ended, 1);
    assert_int_equal(last, 'f');
    for (const char *v = stock_next(&stock, NULL); v; v = stock_next(&stock, v)) ++seen;
    assert_int_equal(seen, COUNT + 1);
    stock_destroy(&stock, false);
    assert_int_equal(ended, COUNT + 2);
    assert_null(stock_next(&stock, NULL));
}

// The sanitizer detects memory that is not freed.
static void what_is_lost_is_not_ended_again(void **state)
{
    Stock stock = {.most = 1};
    (void)state;
    ended = 0;
    stock_return(&stock, add(&stock, "a"));
    add(&stock, "b");
    stock_destroy(&stock, true);
    assert_int_equal(ended, 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_key_finds_its_value_and_no_other),
        cmocka_unit_test(idle_values_stay_and_the_longest_untaken_goes),
        cmocka_unit_test(values_in_use_are_not_counted),
        cmocka_unit_test(what_is_lost_is_not_ended_again),
    };
    return cmocka_run_group_tests_name("stock", tests, NULL, NULL);
}
