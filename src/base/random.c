// SPDX-License-Identifier: MIT
#include "base/random.h"

#include <math.h>

static uint64_t mix(uint64_t z)
{
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
    return z ^ (z >> 31);
}

Random random_create(uint64_t seed, uint64_t stream)
{
    // Mix the seed, because sequences of neighbouring seeds would otherwise be shifted copies.
    return (Random){mix(mix(seed + 0x9e3779b97f4a7c15u) ^ (stream * 0xd1b54a32d192ed03u))};
}

uint64_t random_next(Random *random)
{
    random->state += 0x9e3779b97f4a7c15u;
    return mix(random->state);
}

double random_real(Random *random)
{
    return (double)(random_next(random) >> 11) * 0x1p-53;
}

uint32_t random_below(Random *random, uint32_t count)
{
    // Draw again for 2^32 mod count low products, which would favour some results (Lemire 2019,
    // "Fast random integer generation in an interval").
    uint32_t least = (uint32_t)(0u - count) % count;
    uint64_t product;
    do {
        product = (random_next(random) >> 32) * count;
    } while ((uint32_t)product < least);
    return (uint32_t)(product >> 32);
}

void random_direction(Random *random, double direction[3])
{
    double x, y, square;
    do {
        x = 2.0 * random_real(random) - 1.0;
        y = 2.0 * random_real(random) - 1.0;
        square = x * x + y * y;
    } while (square >= 1.0);
    double scale = 2.0 * sqrt(1.0 - square);
    direction[0] = x * scale;
    direction[1] = y * scale;
    direction[2] = 1.0 - 2.0 * square;
}

void random_permutation(Random *random, uint32_t *order, uint32_t count)
{
    for (uint32_t i = 0; i < count; i++) {
        uint32_t j = random_below(random, i + 1);
        order[i] = order[j];
        order[j] = i;
    }
}
