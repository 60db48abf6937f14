// SPDX-License-Identifier: MIT
// A random order of 0 .. count - 1 that needs no memory. It is a bijection on numbers with the
// required number of bits: three rounds of multiplying by an odd number, adding, and folding the
// upper half of the bits into the lower half. Numbers from count on are skipped.
#include "common/hash.h"

const int SHUFFLE_ROUNDS = 3;

struct Shuffle {
    uint at, count, size; // place in the order; numbers in the order; places, less than 2 count
    int fold;
    uint factor[SHUFFLE_ROUNDS], shift[SHUFFLE_ROUNDS];
};

// Starts at place `at`.
Shuffle shuffle_open(uint seed, uint count, uint at)
{
    Shuffle s;
    int bits = max(findMSB(count - 1u) + 1, 1);
    s.at = at, s.count = count, s.size = 1u << bits, s.fold = (bits + 1) / 2;
    for (int i = 0; i < SHUFFLE_ROUNDS; ++i) {
        s.factor[i] = hash_bits(seed + uint(2 * i)) | 1u;
        s.shift[i] = hash_bits(seed + uint(2 * i + 1));
    }
    return s;
}

// The next number before place `end`; -1 if there is none.
int shuffle_next(inout Shuffle s, uint end)
{
    while (s.at < end) {
        uint number = s.at++;
        for (int i = 0; i < SHUFFLE_ROUNDS; ++i) {
            number = (number * s.factor[i] + s.shift[i]) & (s.size - 1u);
            number ^= number >> s.fold;
        }
        if (number < s.count) return int(number);
    }
    return -1;
}
