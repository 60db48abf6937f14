// SPDX-License-Identifier: MIT
// How each of the programs begins and ends.
#pragma once

#include "base/error.h"

// Handles signals from now on (interrupt_install.h) and notes when memory is short (json.h).
// Paths on the command line may lead to pipes (bytes.h).
void program_begin(int argc, char *const *argv);

// Ends a program. Flushes standard output; if that fails, so does a run without an error of its
// own, unless the reader of a pipe has left. Prints "name: error" unless the text is empty, and
// returns the exit status.
int program_end(const char *name, Result result, Error *error);
