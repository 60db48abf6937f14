// SPDX-License-Identifier: MIT
// Sorts many numbers by their keys.
#pragma once

#include "error.h"

#include <stddef.h>
#include <stdint.h>

// Memory that is kept from one sort to the next. A zeroed struct is empty.
typedef struct Radix {
    uint64_t *pairs[2]; // [room], owned: key in the upper half, number in the lower
    size_t room;
} Radix;

// Writes to `order` [count] the numbers 0 .. count - 1 of the keys that are not 0, largest key
// first, equal keys in ascending order of numbers; returns how many in *sorted. Three passes of
// counting, each 11 bits; those in which all keys agree are skipped. RESULT_FAILED when memory is
// short.
Result radix_sort_descending(Radix *radix, const uint32_t *keys, size_t count, uint32_t *order,
                             size_t *sorted, Error *error);
void radix_destroy(Radix *radix);
