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
    fputs(text, stream);
}

// --- A faster way (10 times) for 1e-4 <= |value| < 1e5, where %g writes no exponent.
//
// With k decimals the number is n = round(|value| 10^k). The product in double has a relative error
// of at most 2^-53, so n is certain unless the product is that close to the midpoint of two
// integers. n / 10^k reads back as `value` if it lies between the midpoints of `value` and its
// neighbouring floats; that is certain, too, unless it is very close to a midpoint. n has at most
// nine digits (below 2^30), which leaves room for generous margins: 2^-20 of a unit and 2^-20 of
// half the gap between floats. Uncertain cases take the slow way.

typedef enum Answer { NO, YES, UNSURE } Answer;

static Answer reads_back(double value, double half_gap, uint32_t n, double power)
{
    double off = fabs(n / power - value) / half_gap;
    if (off > 1 - 0x1p-20 && off < 1 + 0x1p-20) return UNSURE;
    return off < 1 ? YES : NO;
}

// Finds n and k with the fewest significant digits, from 6 to 9. False if the result is uncertain.
static bool find_digits(double value, uint32_t *n, int *decimals)
{
    static const double powers[] = {1,   1e1, 1e2, 1e3,  1e4,  1e5, 1e6,
                                    1e7, 1e8, 1e9, 1e10, 1e11, 1e12};
    int exponent, whole = -3; // binary exponent of value; digits before the point: value < 10^whole
    // A power of two: the gap below is half the gap above.
    if (frexp(value, &exponent) == 0.5) return false;
    double half_gap = ldexp(1, exponent - 25);
    while (value >= (whole >= 0 ? powers[whole] : 1 / powers[-whole])) whole++;
    for (int digits = 6; digits <= 9; digits++) {
        *decimals = digits - whole;
        double product = value * powers[*decimals], nearest = rint(product);
        if (fabs(fabs(product - nearest) - 0.5) < 0x1p-20) return false;
        if (nearest >= powers[digits]) return false; // rounding up added a digit, as for 999999.7
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

void decimal_format_double(double value, char *text, size_t size)
{
    for (int digits = 6; digits <= 17; ++digits) {
        snprintf(text, size, "%.*g", digits, value);
        if (strtod(text, NULL) == value) return;
    }
}

static const char *skip_blanks(const char *text)
{
    return text + strspn(text, " \t");
}

const char *decimal_read(const char *text, double *number)
{
    text = skip_blanks(text);
    size_t length = strspn(text, "0123456789+-.eE");
    char *end;
    *number = strtod(text, &end);
    return end == text || end > text + length ? NULL : skip_blanks(end);
}
