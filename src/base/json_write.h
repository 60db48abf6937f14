// SPDX-License-Identifier: MIT
// JSON results as files.
#pragma once

#include "base/error.h"

#include <jansson.h>

// Writes `value` as an indented file that appears complete or not at all; floats are as short as
// float32 allows. Takes no reference. RESULT_FAILED with path and reason, also for a NULL value
// (memory was short when it was made).
Result json_write_file(const json_t *value, const char *path, Error *error);
