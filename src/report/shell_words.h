// SPDX-License-Identifier: MIT
// Words of a shell's command line, quoted so that they can be pasted.
#pragma once

#include <stdio.h>

// Writes one word as bash, zsh and ksh read it: as it is where nothing in it is special, else in
// single quotes; with control characters or bytes that are no UTF-8 as $'...', which is printable.
void shell_put_word(FILE *stream, const char *word);

// The words with blanks between them, up to a NULL. Free it. NULL when memory is short.
char *shell_join(const char *const *words);

// The command line of `program`, whose first word is what main got instead of that name.
char *shell_join_line(const char *program, int argc, char **argv);
