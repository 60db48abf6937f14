// SPDX-License-Identifier: MIT
// What tractrix-convert tells about hair: as text and as JSON.
#pragma once

#include "convert/convert_input.h"
#include "convert/convert_output.h"
#include "strands/strands_figures.h"

#include <stdio.h>

// What the input is: the report of each file, or the cache's frames.
void convert_print_input(const ConvertInput *input, FILE *stream);

// A table of figures, and how many strands have how many vertices.
void convert_print_figures(const StrandsFigures *figures, FILE *stream);

// All of it. `output`: NULL if none is written. RESULT_FAILED with path and reason.
Result convert_write_json(const char *path, const ConvertInput *input,
                          const StrandsFigures *figures, const ConvertOutput *output, Error *error);
