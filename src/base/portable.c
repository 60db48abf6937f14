// SPDX-License-Identifier: MIT
#include "base/portable.h"

#include "base/random.h"

#include <math.h>

// The Taylor series up to x^15. The remainder is below x^17/17! <= 6.1e-12 for |x| <= pi/2.
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

double portable_noise(double x, double y, double z)
{
    const double p[3] = {x, y, z};
    double low[3], share[3], sum = 0.0;
    for (int i = 0; i < 3; i++) {
        if (!(fabs(p[i]) < 1e15)) return 0.0;
        low[i] = floor(p[i]);
        double t = p[i] - low[i];
        share[i] = t * t * (3.0 - 2.0 * t);
    }
    for (int corner = 0; corner < 8; corner++) {
        static const uint64_t factors[3] = {0x8da6b343u, 0xd8163841u, 0xcb1ab31fu};
        double weight = 1.0;
        uint64_t key = 0;
        for (int i = 0; i < 3; i++) {
            int upper = corner >> i & 1;
            key ^= (uint64_t)(int64_t)(low[i] + upper) * factors[i];
            weight *= upper ? share[i] : 1.0 - share[i];
        }
        Random random = random_create(key, 0x6e6f697365); // "noise"
        sum += weight * (2.0 * random_real(&random) - 1.0);
    }
    return sum;
}
