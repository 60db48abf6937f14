// SPDX-License-Identifier: MIT
// The guarantees of strands_read: numbers are finite and within bounds, strands have 2 to
// STRANDS_MAX_SIZE vertices, and no vertex coincides with the previous one.
#pragma once

#include "formats/format.h"
#include "formats/strands_report.h"

// Mends the strands and frames that were read (in metres), in place, and counts the changes in
// `report`. RESULT_BAD_INPUT if something cannot be mended: a strand that is too long, a frame with
// a number that is not finite, too many followers. RESULT_FAILED when memory is short.
Result strands_mend(FormatSource *source, const char *path, StrandsReport *report, Error *error);

// Checks that strands from another source have the guarantees of strands_read. RESULT_BAD_INPUT
// with the number (from 0) of the first strand that does not: it has fewer than 2 or more than
// STRANDS_MAX_SIZE vertices, a number that is not finite, a coordinate beyond 1e6 m, or a vertex
// that coincides with the previous one.
Result strands_check(const Strands *strands, const char *name, Error *error);
