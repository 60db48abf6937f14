// SPDX-License-Identifier: MIT
// Writes hair. Files appear complete or not at all; coordinates are metres, y up.
#pragma once

#include "strands/strands_report.h"

// The kind for a file whose name ends like this: .hair, .obj, .data, .usda; else TressFX, 4 if
// strands are alike in their number of vertices, else text.
StrandsKind strands_choose_kind(const char *suffix, const Strands *strands);

// Reading the file with unit 1 gives the same float32 values back, bit for bit, for all that the
// kind can hold:
//   STRANDS_TFX2_TEXT  positions and strand UVs as the shortest decimals that read back; followers,
//                      their radius and fixed ends in a block of parameters if there are any
//   STRANDS_TFX3       all but mobility and thickness per vertex
//   STRANDS_TFX4       all but followers and thickness per vertex; where mobility is NULL, 0 is
//                      written for the root (and the tip if both ends are fixed) and 1 for the rest
//   STRANDS_HAIR       positions, thickness per vertex, colour (opacity below 0.5 within 2^-25)
//   STRANDS_SALON_DATA positions
//   STRANDS_OBJ        positions as the shortest decimals that read back
//   STRANDS_USD        everything; not read back (usd_file.h has more)
// What the kind can't hold is left out: strands_features.h tells what that is.
// RESULT_FAILED for TressFX 3 and 4 if strands differ in their number of vertices, for HAIR if a
// strand has more than 65536, for the other kinds, and with the reason if writing fails.
Result strands_write(const char *path, StrandsKind kind, const Strands *strands, Error *error);
