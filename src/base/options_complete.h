// SPDX-License-Identifier: MIT
// Completion of command lines in bash, zsh and fish, from the tables of options.
#pragma once

#include "base/options.h"

// Writes what `shell` (bash, zsh or fish) reads to complete the program's command line: options,
// the words of their values, names of files for FILE and PATH and of folders for DIR, commands, and
// the topics of --help. False, with nothing written, for any other word.
bool options_complete(const OptionsProgram *program, const char *shell, FILE *stream);
