// SPDX-License-Identifier: MIT
// The JSON schema (draft-07) of scene files, from the table of parameters: editors complete and
// check scene files with it.
#pragma once

#include "base/error.h"
#include "base/options.h"

#include <stdio.h>

// A word of `algo` and those of its `variant`, ended by NULL.
typedef struct SchemaSolver {
    const char *name;
    const char *const *variants;
} SchemaSolver;

// Writes the schema. It accepts every file that scene_read accepts, and refuses what a file can be
// refused for by itself: unknown keys, wrong types and words, values out of range. `solvers` end
// with a NULL name; `keys` are help texts for keys that are no parameters: names with ", " between
// them, example, meaning (OptionsChapter). RESULT_FAILED when memory is short.
Result scene_schema_write(const SchemaSolver *solvers, const char *const (*keys)[3], FILE *stream,
                          Error *error);
