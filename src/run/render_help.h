// SPDX-License-Identifier: MIT
// What tractrix-render says about itself, made from the table of parameters.
#pragma once

#include "base/options.h"

// Prints what --help TOPIC asks for, as options_help does; the topics are the groups of params.def
// and the solvers. RESULT_USAGE for another topic, RESULT_FAILED when memory is short.
Result render_help(const char *topic, FILE *stream, Error *error);
