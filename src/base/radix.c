// SPDX-License-Identifier: MIT
#include "base/radix.h"

#include <stdbool.h>
#include <string.h>

enum { DIGIT_BITS = 8, DIGITS = 1 << DIGIT_BITS, PASSES = 4 };

static uint32_t digit_of(uint64_t pair, int pass)
{
    return (uint32_t)(pair >> (32 + pass * DIGIT_BITS)) & (DIGITS - 1);
}

// Turns the counts of the digits into their first places. False if all pairs have the same digit.
static bool find_places(uint32_t places[DIGITS], size_t count)
{
    uint32_t at = 0;
    for (int d = 0; d < DIGITS; ++d) {
        uint32_t here = places[d];
        if (here == count) return false;
        places[d] = at;
        at += here;
    }
    return true;
}

uint64_t *radix_sort(uint64_t *pairs, uint64_t *other, size_t count)
{
    uint32_t places[PASSES][DIGITS] = {0};
    for (size_t i = 0; i < count; ++i)
        for (int pass = 0; pass < PASSES; ++pass) ++places[pass][digit_of(pairs[i], pass)];
    for (int pass = 0; pass < PASSES && count; ++pass) {
        if (!find_places(places[pass], count)) continue;
        for (size_t i = 0; i < count; ++i)
            other[places[pass][digit_of(pairs[i], pass)]++] = pairs[i];
        uint64_t *from = pairs;
        pairs = other, other = from;
    }
    return pairs;
}
