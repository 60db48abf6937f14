// SPDX-License-Identifier: MIT
// The JSON schema (draft-07) of scene files, made from the table of parameters. Editors complete
// and check scene files with it.
#pragma once

#include "base/error.h"
#include "base/options.h"

#include <stdio.h>

// A word of `algo` and its words of `variant`, terminated by NULL.
typedef struct SchemaSolver {
    const char *name;
    const char *const *variants;
} SchemaSolver;

// Writes the schema. It accepts every file that scene_read accepts, and rejects everything that can
// be seen from the file alone: unknown keys, wrong types and words, values out of range. `solvers`
// is terminated by a NULL name; `keys` are help texts for keys that are not parameters: names
// separated by ", ", example, meaning (OptionsChapter). RESULT_FAILED when memory is short.
Result scene_schema_write(const SchemaSolver *solvers, const char *const (*keys)[3], FILE *stream,
                          Error *error);
