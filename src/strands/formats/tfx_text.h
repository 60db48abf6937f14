// SPDX-License-Identifier: MIT
// TressFX 2 text: `numStrands`, `is sorted`, then each strand's vertices, with or without a block
// of parameters in front.
#pragma once

#include "strands/formats/strands_source.h"

// Whether the content begins with a word of this format.
bool tfx_text_matches(const Bytes *bytes);

// Reads it all, positions in the file's unit. Numbers of a rotation are radians, as AMD's loader
// takes them, unless one is beyond a full turn (2 pi): then all three are degrees.
Result tfx_text_read(StrandsSource *source, Reader *reader);
