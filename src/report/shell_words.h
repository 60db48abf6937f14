// SPDX-License-Identifier: MIT
// Words of a shell's command line, quoted so that they can be pasted.
#pragma once

#include <stdio.h>

// Writes a word for bash, zsh and ksh: unquoted if it has no special characters, otherwise in
// single quotes; with control characters or invalid UTF-8 as $'...', which is printable.
void shell_put_word(FILE *stream, const char *word);

// Joins the words up to NULL with blanks. The caller frees the result; NULL when memory is short.
char *shell_join(const char *const *words);

// The command line of `program`, which replaces argv[0].
char *shell_join_line(const char *program, int argc, char **argv);
