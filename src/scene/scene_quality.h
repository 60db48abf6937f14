// SPDX-License-Identifier: MIT
// --quality: other defaults for several parameters at once. What a flag or a scene file says of a
// parameter wins, whatever the order.
#pragma once

#include "base/params.h"

// Gives the fields of `params`, a RunParams or SectionParams as the scope says, the preset's
// defaults. RESULT_FAILED when memory is short.
Result quality_apply(Quality quality, ParamScope scope, void *params, Error *error);

// Reads a word of --quality. RESULT_USAGE for another one.
Result quality_parse(Quality *quality, const char *word, Error *error);
