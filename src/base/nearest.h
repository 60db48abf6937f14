// SPDX-License-Identifier: MIT
// The nearest of many points: a balanced k-d tree.
#pragma once

#include "base/error.h"

#include <stdint.h>

// The points lie in the order of the tree: the middle of a range splits it along the range's axis.
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

// `point` (finite) outlives the tree. RESULT_FAILED when memory is short. O(n log n) on average.
Result nearest_create(Nearest *nearest, const float (*point)[3], uint32_t count, Error *error);
void nearest_destroy(Nearest *nearest);

// The `most` points nearest to point `self`, itself not among them, nearest first, equal distances
// in any order. Returns how many there are.
uint32_t nearest_find(const Nearest *nearest, uint32_t self, Neighbour *found, uint32_t most);

// The same for any place.
uint32_t nearest_find_at(const Nearest *nearest, const float from[3], Neighbour *found,
                         uint32_t most);
