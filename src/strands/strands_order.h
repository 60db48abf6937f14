// SPDX-License-Identifier: MIT
// Which strands, and in what order. The order matters where only the first so many are used (level
// of detail).
#pragma once

#include "strands/strands.h"

// Strand i becomes what strand order[i] was, with all its attributes; `order` is a permutation of
// 0 .. strand_count - 1. RESULT_FAILED when memory is short; then nothing has changed.
Result strands_reorder(Strands *strands, const uint32_t *order, Error *error);

// Strand i < count becomes what strand which[i] was; those that are not named are gone. Errors as
// above.
Result strands_pick(Strands *strands, const uint32_t *which, uint32_t count, Error *error);

// Keeps a random share (0 .. 1) of the strands, at least one, in their order; the same ones for the
// same seed and number of strands. Errors as above.
Result strands_thin(Strands *strands, double share, uint32_t seed, Error *error);

// Puts the strands in an order that depends on `seed` and their number only.
Result strands_shuffle(Strands *strands, uint32_t seed, Error *error);
