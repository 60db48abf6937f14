// SPDX-License-Identifier: MIT
// Which strands of a groom are neighbours, and how many of them still are in other positions of the
// same strands: whether locks hold together.
#pragma once

#include "base/error.h"

#include <stdint.h>

// Two vertices of different strands that were neighbours, and how near they must be to be so still.
typedef struct Bond {
    uint32_t vertex[2];
    float reach; // m
} Bond;

typedef struct GroomLocks {
    Bond *bond; // owned
    uint32_t bond_count;
} GroomLocks;

// Finds them in the groom: point[first[s] .. first[s + 1] - 1] are strand s's from root to tip, m.
// At each of three heights (shares of a strand's vertices: 1/3, 2/3, the tip) the groom's
// spacing is the median distance to a strand's 8th neighbour; its 8 nearest that are no farther off
// are its neighbours. RESULT_FAILED when memory is short. The locks may be destroyed in either
// case.
Result groom_locks_create(GroomLocks *locks, const float (*point)[3], const uint32_t *first,
                          uint32_t strand_count, Error *error);
void groom_locks_destroy(GroomLocks *locks);

// The share of neighbours that are not farther apart than twice the groom's spacing: 1 in the
// groom; NaN if it has none.
double groom_locks_kept(const GroomLocks *locks, const float (*point)[3]);
