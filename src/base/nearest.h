// SPDX-License-Identifier: MIT
// Nearest neighbours among many points: a balanced k-d tree.
#pragma once

#include "base/error.h"

#include <stdint.h>

// Points are in the order of the tree: the middle of a range splits it along the range's axis.
typedef struct Nearest {
    const float (*point)[3]; // not owned
    uint32_t *order;         // [count], owned
    uint32_t count;
} Nearest;

// A point and its squared distance.
typedef struct Neighbour {
    uint32_t point;
    double square;
} Neighbour;

// `point` (finite) must outlive the tree. RESULT_FAILED when memory is short. O(n log n) on
// average.
Result nearest_create(Nearest *nearest, const float (*point)[3], uint32_t count, Error *error);
void nearest_destroy(Nearest *nearest);

// The `most` points nearest to point `self`, without itself, nearest first (equal distances in any
// order). Returns their number.
uint32_t nearest_find(const Nearest *nearest, uint32_t self, Neighbour *found, uint32_t most);

// The same for any position.
uint32_t nearest_find_at(const Nearest *nearest, const float from[3], Neighbour *found,
                         uint32_t most);
