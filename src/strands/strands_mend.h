// SPDX-License-Identifier: MIT
// Turns a file's content into strands that everything else may rely on.
#pragma once

#include "strands/formats/strands_source.h"
#include "strands/strands_report.h"

enum { STRANDS_MAX_SIZE = 65535 }; // vertices of one strand

// To metres, y up: p' = unit * (translation + rotation * (scale * p)), then (x, y, z) -> (x, z, -y)
// if `up_z`. Computed in double and rounded once; with unit 1 and none of the others, bits stay.
void strands_convert(StrandsSource *source, double unit, bool up_z);

// Mends positions that are in metres, in place. Afterwards every strand has 2 .. STRANDS_MAX_SIZE
// vertices, coordinates are finite and at most 1e6 m, and neighbours lie further apart than
// 1e-7 of the strand's largest coordinate and than 1e-9 m, so that float32 gives their difference a
// direction. A merged vertex takes its attributes along. Counts what it does in
// `report->defects` and `report->empty_roots`. Fails (RESULT_BAD_INPUT) only for a strand that is
// longer than the maximum.
Result strands_mend(StrandsSource *source, const char *path, StrandsReport *report, Error *error);
