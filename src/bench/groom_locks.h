// SPDX-License-Identifier: MIT
// Which strands of a groom are neighbours, and how many of these stay close when the strands move:
// whether locks hold together.
#pragma once

#include "base/error.h"

#include <stdint.h>

// Two vertices of neighbouring strands, and the distance up to which they count as close.
typedef struct Bond {
    uint32_t vertex[2];
    float reach; // m
} Bond;

typedef struct GroomLocks {
    Bond *bond; // owned
    uint32_t bond_count;
} GroomLocks;

// Finds neighbours in the groom: point[first[s] .. first[s + 1] - 1] are strand s's from root to
// tip, m. The groom's spacing at each of three heights (1/3, 2/3 and all of a strand's vertices) is
// the median distance to a strand's 8th neighbour. A strand's neighbours are its 8 nearest strands
// within that distance. RESULT_FAILED when memory is short. The locks may be destroyed in either
// case.
Result groom_locks_create(GroomLocks *locks, const float (*point)[3], const uint32_t *first,
                          uint32_t strand_count, Error *error);
void groom_locks_destroy(GroomLocks *locks);

// The share of neighbours whose distance is at most twice the groom's spacing: 1 in the groom; NaN
// without neighbours.
double groom_locks_kept(const GroomLocks *locks, const float (*point)[3]);
