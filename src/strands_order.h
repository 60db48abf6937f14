// SPDX-License-Identifier: MIT
// The order of strands. It matters where only the first so many are used (level of detail).
#pragma once

#include "strands.h"

// Strand i becomes what strand order[i] was, with all its attributes; `order` is a permutation of
// 0 .. strand_count - 1. RESULT_FAILED when memory is short; then nothing has changed.
Result strands_reorder(Strands *strands, const uint32_t *order, Error *error);

// Puts the strands in an order that depends on `seed` and their number only.
Result strands_shuffle(Strands *strands, uint32_t seed, Error *error);
