// SPDX-License-Identifier: MIT
// Several sets of strands as one.
#pragma once

#include "strands/strands.h"

// One set behind the other. Optional arrays and what a file asks for of followers are kept if all
// sets have them (followers: the same ones). RESULT_FAILED when memory is short or 32-bit indices
// are.
Result strands_join(Strands *all, const Strands *sets, uint32_t count, Error *error);
