// SPDX-License-Identifier: MIT
#include "base/rate.h"
#include "base/decimal.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

double rate_snap(double rate)
{
    static const int rates[] = {24, 30, 48, 60, 120};
    for (int i = 0; i < 5; ++i) {
        double exact = rates[i] * 1000 / 1001.0;
        if (fabs(rate - exact) < 0.005 && fabs(rate - exact) < fabs(rate - round(rate)))
            return exact;
    }
    return rate;
}

bool rate_parse(const char *text, double *rate)
{
    double number, divisor = 1;
    const char *at = decimal_read(text, &number);
    bool fraction = at && *at == '/';
    if (fraction) at = decimal_read(at + 1, &divisor);
    if (!at || *at || !(divisor > 0)) return false;
    number = fraction ? number / divisor : rate_snap(number);
    *rate = number;
    return true;
}

static long find_divisor(long a, long b)
{
    while (b) {
        long rest = a % b;
        a = b;
        b = rest;
    }
    return a;
}

void rate_fraction(double rate, long *numerator, long *denominator)
{
    static const long units[] = {1, 1001, 1000000};
    for (int i = 0; i < 3; ++i) {
        // Rates over 1001 have whole thousands as numerators.
        double count = rate * (double)units[i], step = units[i] == 1001 ? 1000 : 1;
        *denominator = units[i];
        *numerator = lround(count / step) * (long)step;
        if (fabs((double)*numerator / count - 1) < 1e-9) break;
    }
    if (*numerator < 1) *numerator = 1;
    long divisor = find_divisor(*numerator, *denominator);
    *numerator /= divisor;
    *denominator /= divisor;
}

void rate_format(double rate, char *text, size_t size)
{
    long numerator, denominator;
    double back = 0;
    if (rate > 0 && rate < 2000) {
        rate_fraction(rate, &numerator, &denominator);
        snprintf(text, size, "%ld/%ld", numerator, denominator);
        if (denominator == 1001 && rate_parse(text, &back) && back == rate) return;
    }
    decimal_format_double(rate, text, size);
}
