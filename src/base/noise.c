// SPDX-License-Identifier: MIT
#include "base/noise.h"

#include "base/random.h"

#include <math.h>

static double at_corner(double x, double y, double z)
{
    uint64_t key = (uint64_t)(int64_t)x * 0x8da6b343u ^ (uint64_t)(int64_t)y * 0xd8163841u ^
                   (uint64_t)(int64_t)z * 0xcb1ab31fu;
    Random random = random_create(key, 0x6e6f697365); // "noise"
    return 2.0 * random_real(&random) - 1.0;
}

static double smooth(double t)
{
    return t * t * (3.0 - 2.0 * t);
}

double noise_at(double x, double y, double z)
{
    const double p[3] = {x, y, z};
    double low[3], share[3], sum = 0.0;
    for (int i = 0; i < 3; i++) {
        if (!(fabs(p[i]) < 1e15)) return 0.0;
        low[i] = floor(p[i]);
        share[i] = smooth(p[i] - low[i]);
    }
    for (int corner = 0; corner < 8; corner++) {
        double weight = 1.0, at[3];
        for (int i = 0; i < 3; i++) {
            int upper = corner >> i & 1;
            at[i] = low[i] + upper;
            weight *= upper ? share[i] : 1.0 - share[i];
        }
        sum += weight * at_corner(at[0], at[1], at[2]);
    }
    return sum;
}
