// SPDX-License-Identifier: MIT
// Frame rates: decimals or fractions of whole numbers. Those of NTSC are N 1000/1001; 23.976,
// 23.98, 29.97, 59.94 and the like stand for them.
#pragma once

#include <stdbool.h>
#include <stddef.h>

// Parses "25", "23.976" or "24000/1001", with blanks around numbers. False if it is neither. The
// caller checks the range: the rate may be infinite, 0 or less.
bool rate_parse(const char *text, double *rate);

// The rate that a decimal stands for: within 0.005 of N 1000/1001 (N: 24, 30, 48, 60, 120) that
// rate, unless it is nearer to a whole number.
double rate_snap(double rate);

// Writes the shortest text that rate_parse reads back exactly: "24000/1001" or a decimal.
void rate_format(double rate, char *text, size_t size);

// The rate as a reduced fraction: exact for whole rates and those over 1001, otherwise rounded to
// 1/1,000,000. 0 < rate < 2,000.
void rate_fraction(double rate, long *numerator, long *denominator);
