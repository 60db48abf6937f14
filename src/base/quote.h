// SPDX-License-Identifier: MIT
// Text from outside in a message: names and words of files, arguments, words of drivers. Whatever
// their bytes are, a message stays one line, does nothing to a terminal, and is not cut at its end,
// where the reason stands.
#pragma once

#include <stddef.h>

enum { QUOTED_BYTES = 400 };

typedef struct Quoted {
    char text[QUOTED_BYTES];
} Quoted;

// Copies `text` into `line` of `size` bytes (>= 16), which ends with a zero: line ends and tabs as
// \n, \r and \t, other characters that do not stand visibly on a line, and bytes that are no UTF-8,
// as \x1b; a text that does not fit has "..." in its middle, so that its beginning and its end
// stay. Copying twice changes nothing more. They may be the same memory only if the text fits as it
// is.
void quote_line(char *line, size_t size, const char *text);

// The same by value, for a name within a call: fprintf(stderr, "%s: ...", quote(path).text).
Quoted quote(const char *text);
