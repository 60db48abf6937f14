// SPDX-License-Identifier: MIT
// `.data` (USC-HairSalon) and `.bin` (CT2Hair): a count of strands, then each strand's count of
// vertices with the vertices behind it, 3 or 7 floats each. Nothing but their counts marks these
// files, so a file is one of them if its strands end where the file does.
#pragma once

#include "strands/formats/strands_source.h"

enum { SALON_DATA_FLOATS = 3, SALON_BIN_FLOATS = 7 };

// SALON_DATA_FLOATS or SALON_BIN_FLOATS; 0 if the content is neither.
int salon_file_match(const Bytes *bytes);

// `floats` as salon_file_match returned it. Only the first 3 floats of a vertex are used.
Result salon_file_read(StrandsSource *source, Reader *reader, int floats);
