// SPDX-License-Identifier: MIT
// Completion of command lines in bash, zsh and fish, from the tables of options.
#pragma once

#include "base/options.h"

// Writes the completion script for `shell` (bash, zsh or fish): options, words of their values,
// file names for FILE and PATH and folders for DIR, commands, and the topics of --help. For any
// other word writes nothing and returns false.
bool options_complete(const OptionsProgram *program, const char *shell, FILE *stream);
