// SPDX-License-Identifier: MIT
// Sorts many numbers by their keys.
#pragma once

#include <stddef.h>
#include <stdint.h>

// Sorts `count` pairs by their upper halves in ascending order; the sort is stable. `other` must
// have the same size. Returns the array with the result, `pairs` or `other`; the other one is
// overwritten.
uint64_t *radix_sort(uint64_t *pairs, uint64_t *other, size_t count);
