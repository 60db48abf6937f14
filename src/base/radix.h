// SPDX-License-Identifier: MIT
// Sorts many numbers by their keys.
#pragma once

#include <stddef.h>
#include <stdint.h>

// Sorts `count` pairs by their upper halves, least first; pairs that agree in them stay in order.
// `other` has room for as many. Returns where the result is, `pairs` or `other`; the other one is
// used up.
uint64_t *radix_sort(uint64_t *pairs, uint64_t *other, size_t count);
