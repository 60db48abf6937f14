// SPDX-License-Identifier: MIT
#include "base/decimal.h"

#include <math.h>
#include <stdbool.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

static void put_slowly(FILE *stream, float value)
{
    char text[40];
    for (int digits = 6; digits <= 9; digits++) {
        snprintf(text, sizeof text, "%.*g", digits, (double)value);
        if (strtof(text, NULL) == value) break;
    }
    // What stands between the digits is the locale's decimal separator, of one or more bytes.
    size_t whole = strspn(text, "+-0123456789einfa");
    size_t separator = strcspn(text + whole, "0123456789");
    fprintf(stream, "%.*s", (int)whole, text);
    if (text[whole]) fprintf(stream, ".%s", text + whole + separator);
}

// --- The same, ten times as fast, for 1e-4 <= |value| < 1e5, where %g writes no exponent.
//
// With k decimals the number is n = round(|value| 10^k). The product is exact but for one rounding
// to double, 2^-53 of it: n is right unless the product lies that close to the middle between two
// whole numbers. n / 10^k, rounded once as well, reads back as `value` if it lies between the
// middles of `value` and its neighbours, and that is certain unless it is that close to one. Nine
// digits are below 2^30, so that "close" may be generous: 2^-20 of a unit, and 2^-20 of the gap
// between two floats. What is not certain goes the slow way.

typedef enum Answer { NO, YES, UNSURE } Answer;

static Answer reads_back(double value, double half_gap, uint32_t n, double power)
{
    double off = fabs(n / power - value) / half_gap;
    if (off > 1 - 0x1p-20 && off < 1 + 0x1p-20) return UNSURE;
    return off < 1 ? YES : NO;
}

// Finds n and k of the fewest significant digits from 6 to 9; false if it is not certain.
static bool find_digits(double value, uint32_t *n, int *decimals)
{
    static const double powers[] = {1,   1e1, 1e2, 1e3,  1e4,  1e5, 1e6,
                                    1e7, 1e8, 1e9, 1e10, 1e11, 1e12};
    int exponent, whole = -3; // of value; of its first digit: value < 10^whole
    if (frexp(value, &exponent) == 0.5) return false; // the gap below is half the one above
    double half_gap = ldexp(1, exponent - 25);
    while (value >= (whole >= 0 ? powers[whole] : 1 / powers[-whole])) whole++;
    for (int digits = 6; digits <= 9; digits++) {
        *decimals = digits - whole;
        double product = value * powers[*decimals], nearest = rint(product);
        if (fabs(fabs(product - nearest) - 0.5) < 0x1p-20) return false;
        if (nearest >= powers[digits]) return false; // 999999.7 has a digit more
        *n = (uint32_t)nearest;
        Answer answer = reads_back(value, half_gap, *n, powers[*decimals]);
        if (answer == UNSURE) return false;
        if (answer == YES) return true;
    }
    return false;
}

static bool put_fast(FILE *stream, float value)
{
    double size = fabs((double)value);
    char text[24], *end = text + sizeof text, *at = end;
    uint32_t n;
    int decimals;
    if (!(size >= 1e-4 && size < 1e5) || !find_digits(size, &n, &decimals)) return false;
    for (; decimals > 0 && n % 10 == 0; decimals--) n /= 10;
    for (int i = 0; i < decimals; i++, n /= 10) *--at = (char)('0' + n % 10);
    if (decimals > 0) *--at = '.';
    do *--at = (char)('0' + n % 10);
    while (n /= 10);
    if (value < 0) *--at = '-';
    fwrite(at, 1, (size_t)(end - at), stream);
    return true;
}

void decimal_put(FILE *stream, const char *before, float value)
{
    fputs(before, stream);
    if (value == 0 && !signbit(value))
        fputc('0', stream);
    else if (!put_fast(stream, value))
        put_slowly(stream, value);
}

void decimal_format(float value, char *text, size_t size)
{
    // %g would write 60 as 6e+01.
    if (fabsf(value) < 1e7f && truncf(value) == value) {
        snprintf(text, size, "%.0f", (double)value);
        return;
    }
    for (int digits = 1; digits <= 9; digits++) {
        snprintf(text, size, "%.*g", digits, (double)value);
        if (strtof(text, NULL) == value) return;
    }
}
