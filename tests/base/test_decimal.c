// SPDX-License-Identifier: MIT
// Decimals that read back: a value is written in the shortest of the forms %.6g to %.9g that reads
// back to it.
#include "base/decimal.h"
#include "base/random.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

static void shortest(float value, char *text, size_t size)
{
    for (int digits = 6; digits <= 9; ++digits) {
        snprintf(text, size, "%.*g", digits, (double)value);
        if (strtof(text, NULL) == value) return;
    }
}

// Writes all values, one per line, and compares the file.
static void check(const float *values, size_t count)
{
    char *text = NULL, expected[40];
    size_t size;
    FILE *stream = open_memstream(&text, &size);
    assert_non_null(stream);
    for (size_t i = 0; i < count; ++i) {
        decimal_put(stream, "", values[i]);
        fputc('\n', stream);
    }
    assert_int_equal(fclose(stream), 0);
    const char *at = text;
    for (size_t i = 0; i < count; ++i) {
        const char *end = memchr(at, '\n', size - (size_t)(at - text));
        shortest(values[i], expected, sizeof expected);
        if ((size_t)(end - at) != strlen(expected) || memcmp(at, expected, strlen(expected)) != 0)
            fail_msg("%a: got %.*s, expected %s", (double)values[i], (int)(end - at), at, expected);
        at = end + 1;
    }
    free(text);
}

static void numbers_of_any_size_are_the_shortest(void **state)
{
    (void)state;
    enum { COUNT = 200000 };
    float *values = malloc(COUNT * sizeof *values);
    Random random = random_create(7, 1);
    for (int i = 0; i < COUNT; ++i) {
        uint32_t bits = (uint32_t)random_next(&random);
        memcpy(&values[i], &bits, sizeof bits);
        if (!isfinite(values[i])) values[i] = 0;
        if (i % 4) // most values have sizes that occur in hair
            values[i] = (float)((random_real(&random) - 0.5) * pow(10, (double)(i % 10) - 5));
    }
    check(values, COUNT);
    free(values);
}

// Decimals with few digits, powers of two, and the neighbours of both.
static void round_numbers_and_their_neighbours_are_the_shortest(void **state)
{
    (void)state;
    enum { COUNT = 60000 };
    float *values = malloc(3 * COUNT * sizeof *values);
    for (int i = 0; i < COUNT; ++i) {
        float value = i < 300 ? ldexpf(1, i - 150) : (float)(i * pow(10, (double)(i % 9) - 7));
        values[3 * i] = i % 2 ? value : -value;
        values[3 * i + 1] = nextafterf(value, INFINITY);
        values[3 * i + 2] = nextafterf(value, 0);
    }
    for (int i = 0; i < 3 * COUNT; ++i)
        if (!isfinite(values[i])) values[i] = -0.0f;
    check(values, 3 * COUNT);
    free(values);
}

// Messages print whole numbers below ten million as such, and other numbers with the fewest digits
// that read back.
static void numbers_in_messages_are_short(void **state)
{
    (void)state;
    static const struct {
        float value;
        const char *text;
    } cases[] = {
        {60, "60"},    {-3, "-3"},           {9999999, "9999999"},   {1e10f, "1e+10"},
        {0.1f, "0.1"}, {2.5e-7f, "2.5e-07"}, {16777216, "16777216"}, {12.3456f, "12.3456"}};
    for (size_t i = 0; i < sizeof cases / sizeof *cases; ++i) {
        char text[40];
        decimal_format(cases[i].value, text, sizeof text);
        if (strcmp(text, cases[i].text) != 0) fail_msg("%s, expected %s", text, cases[i].text);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(numbers_in_messages_are_short),
        cmocka_unit_test(numbers_of_any_size_are_the_shortest),
        cmocka_unit_test(round_numbers_and_their_neighbours_are_the_shortest),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
