// SPDX-License-Identifier: MIT
// Reads hair files from memory. The content is copied to a block of its exact size (and the zero
// after it), so that a sanitizer sees every read beyond it. The files' name is FILE.
#pragma once

#include "formats/strands_read.h"

extern const StrandsReadOptions METRES; // the unit is a metre

// strands_read of these bytes, or of this text.
Result reading_copy(Strands *strands, const void *data, size_t size,
                    const StrandsReadOptions *options, StrandsReport *report, Error *error);
Result reading_text(Strands *strands, const char *text, const StrandsReadOptions *options,
                    StrandsReport *report, Error *error);

// Reads text that must be good, in metres.
Strands reading_good(const char *text, StrandsReport *report);
