// SPDX-License-Identifier: MIT
// What strands_read promises of strands: that numbers are finite and within bounds, that strands
// have 2 to STRANDS_MAX_SIZE vertices, and that no vertex coincides with the one before it.
#pragma once

#include "strands/formats/format.h"
#include "strands/strands_report.h"

// Mends what was read, in metres, in place, its frames alike, and counts in `report` what it did.
// RESULT_BAD_INPUT for what cannot be mended: a strand that is too long, a frame with a number that
// is not finite, too many followers; RESULT_FAILED when memory is short.
Result strands_mend(FormatSource *source, const char *path, StrandsReport *report, Error *error);

// Whether strands that come from no file are as strands_read leaves them. RESULT_BAD_INPUT with the
// number of the first strand, from 0, that is not: of fewer than 2 or more than STRANDS_MAX_SIZE
// vertices, with a number that is not finite or a coordinate beyond 1e6 m, or with a vertex that
// coincides with the one before it.
Result strands_check(const Strands *strands, const char *name, Error *error);
