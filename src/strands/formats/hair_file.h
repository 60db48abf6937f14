// SPDX-License-Identifier: MIT
// `.hair`, Cem Yuksel's HAIR files: a header of 128 bytes, then the arrays that its bit field
// names.
#pragma once

#include "strands/formats/strands_source.h"

enum {
    HAIR_HEADER_BYTES = 128,
    HAIR_HAS_SEGMENTS = 1,
    HAIR_HAS_POINTS = 2,
    HAIR_HAS_THICKNESS = 4,
    HAIR_HAS_TRANSPARENCY = 8,
    HAIR_HAS_COLOR = 16,
};

// Whether the content begins as such a file, with "HAIR".
bool hair_file_matches(const Bytes *bytes);

// The reader stands at byte 0. Where only one of colour and transparency is an array, the header's
// default stands in for the other; where neither is, and for thickness, defaults are left out.
Result hair_file_read(StrandsSource *source, Reader *reader);
