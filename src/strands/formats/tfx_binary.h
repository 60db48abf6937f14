// SPDX-License-Identifier: MIT
// TressFX 3 and 4 binary, after AMD's TressFXFileFormat.h: a header with offsets, then arrays of
// float32.
#pragma once

#include "strands/formats/strands_source.h"

enum { TFX3_HEADER_BYTES = 296, TFX4_HEADER_BYTES = 160 };

// The version in the first four bytes if that is 3 (up to 4) or 4 (up to 5), else 0.
float tfx_binary_version(const Bytes *bytes);

// The reader stands at byte 0. Arrays that the header gives no offset are left NULL.
Result tfx3_read(StrandsSource *source, Reader *reader);
Result tfx4_read(StrandsSource *source, Reader *reader);
