// SPDX-License-Identifier: MIT
// Writing `.ply` (ply_file.c): hairutil's form, with its edges, which other programs draw.
#pragma once

#include "base/outfile.h"
#include "strands/strands.h"

// Little-endian numbers. RESULT_FAILED if a strand has more vertices than the form can count.
Result ply_write(OutFile *file, const Strands *strands, Error *error);

// The same as text.
Result ply_write_text(OutFile *file, const Strands *strands, Error *error);
