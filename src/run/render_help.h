// SPDX-License-Identifier: MIT
// The help of tractrix-render, made from the table of parameters.
#pragma once

#include "base/options.h"

// Prints --help TOPIC like options_help; the topics are the groups of params.def and the solvers.
// RESULT_USAGE for another topic, RESULT_FAILED when memory is short.
Result render_help(const char *topic, FILE *stream, Error *error);
