// SPDX-License-Identifier: MIT
#include "base/portable_sine.h"

#include <math.h>

// The Taylor series up to x^15: what is left out is below x^17/17! <= 6.1e-12 for |x| <= pi/2.
static double quarter_sine(double turns)
{
    double x = 6.283185307179586477 * turns, q = x * x;
    double sum = 1.0 - q * (1.0 / 210.0);
    sum = 1.0 - q * (1.0 / 156.0) * sum;
    sum = 1.0 - q * (1.0 / 110.0) * sum;
    sum = 1.0 - q * (1.0 / 72.0) * sum;
    sum = 1.0 - q * (1.0 / 42.0) * sum;
    sum = 1.0 - q * (1.0 / 20.0) * sum;
    sum = 1.0 - q * (1.0 / 6.0) * sum;
    return x * sum;
}

double portable_sine(double turns)
{
    double share = turns - floor(turns + 0.5); // -0.5 .. 0.5
    if (share > 0.25) share = 0.5 - share;
    if (share < -0.25) share = -0.5 - share;
    return quarter_sine(share);
}

double portable_cosine(double turns)
{
    return portable_sine(turns + 0.25);
}
