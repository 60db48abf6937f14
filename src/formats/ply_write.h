// SPDX-License-Identifier: MIT
// Writes `.ply` (see ply_file.c) in hairutil's form, with edges, which other programs draw.
#pragma once

#include "base/outfile.h"
#include "strands/strands.h"

// Writes little-endian numbers. RESULT_FAILED if a strand has more vertices than the form can
// count.
Result ply_write(OutFile *file, const Strands *strands, Error *error);

// Writes text.
Result ply_write_text(OutFile *file, const Strands *strands, Error *error);
