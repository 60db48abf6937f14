// SPDX-License-Identifier: MIT
#include "radix.h"

#include <stdbool.h>
#include <stdlib.h>

enum { DIGIT_BITS = 11, DIGITS = 1 << DIGIT_BITS, PASSES = 3 };

static uint32_t digit_of(uint64_t pair, int pass)
{
    return (uint32_t)(pair >> (32 + pass * DIGIT_BITS)) & (DIGITS - 1);
}

static Result make_room(Radix *radix, size_t count, Error *error)
{
    if (radix->room >= count) return RESULT_OK;
    radix_destroy(radix);
    for (int i = 0; i < 2; ++i) radix->pairs[i] = malloc(count * sizeof(uint64_t));
    if (!radix->pairs[0] || !radix->pairs[1]) {
        radix_destroy(radix);
        return error_set(error, RESULT_FAILED, "no memory to sort %zu numbers", count);
    }
    radix->room = count;
    return RESULT_OK;
}

// Counts of each digit become the places of its first pair. False if there is only one digit.
static bool find_places(size_t places[DIGITS], size_t count)
{
    size_t at = 0;
    for (int d = 0; d < DIGITS; ++d) {
        size_t here = places[d];
        if (here == count) return false;
        places[d] = at;
        at += here;
    }
    return true;
}

Result radix_sort_descending(Radix *radix, const uint32_t *keys, size_t count, uint32_t *order,
                             size_t *sorted, Error *error)
{
    size_t places[PASSES][DIGITS] = {0}, kept = 0;
    Result result = make_room(radix, count, error);
    if (result != RESULT_OK) return result;
    uint64_t *from = radix->pairs[0], *to = radix->pairs[1];
    for (size_t i = 0; i < count; ++i) {
        if (keys[i] == 0) continue;
        uint64_t pair = (uint64_t)~keys[i] << 32 | i;
        from[kept++] = pair;
        for (int pass = 0; pass < PASSES; ++pass) ++places[pass][digit_of(pair, pass)];
    }
    for (int pass = 0; pass < PASSES && kept; ++pass) {
        if (!find_places(places[pass], kept)) continue;
        for (size_t i = 0; i < kept; ++i) to[places[pass][digit_of(from[i], pass)]++] = from[i];
        uint64_t *other = from;
        from = to, to = other;
    }
    for (size_t i = 0; i < kept; ++i) order[i] = (uint32_t)from[i];
    *sorted = kept;
    return RESULT_OK;
}

void radix_destroy(Radix *radix)
{
    free(radix->pairs[0]);
    free(radix->pairs[1]);
    *radix = (Radix){0};
}
