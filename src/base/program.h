// SPDX-License-Identifier: MIT
// How each of the programs ends.
#pragma once

#include "base/error.h"

// Flushes the standard output, which fails a run that has not failed with a message of its own.
// Tells what went wrong on the standard error: a file's fault (RESULT_BAD_INPUT) begins with the
// file, everything else with the program's `name`; an empty text says nothing. Gives the exit
// status.
int program_end(const char *name, Result result, Error *error);
