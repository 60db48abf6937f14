// SPDX-License-Identifier: MIT
// Seeded pseudo-random numbers: SplitMix64 (Steele, Lea, Flood 2014, "Fast splittable pseudorandom
// number generators"). Uses only integers, one division and square roots, so every machine gets the
// same numbers. Not for cryptography.
#pragma once

#include <stdint.h>

// A copy continues the same sequence independently; any state is valid.
typedef struct Random {
    uint64_t state;
} Random;

// An independent sequence for each pair; `stream` distinguishes uses of the same seed.
Random random_create(uint64_t seed, uint64_t stream);

// The next 64 bits.
uint64_t random_next(Random *random);

// Uniform in [0, 1), a multiple of 2^-53.
double random_real(Random *random);

// Uniform in 0 .. count - 1, without bias; count >= 1.
uint32_t random_below(Random *random, uint32_t count);

// Uniform on the unit sphere (Marsaglia 1972, "Choosing a point from the surface of a sphere").
void random_direction(Random *random, double direction[3]);

// A random permutation of 0 .. count - 1 (Fisher and Yates).
void random_permutation(Random *random, uint32_t *order, uint32_t count);
