// SPDX-License-Identifier: MIT
// Quotes foreign text for messages: file names, arguments, driver messages. Whatever bytes it has,
// the message stays one line, does not affect the terminal, and is not cut at its end, where the
// reason stands.
#pragma once

#include <stddef.h>

enum { QUOTED_BYTES = 400 };

typedef struct Quoted {
    char text[QUOTED_BYTES];
} Quoted;

// Copies `text` to `line` of `size` bytes (>= 16), terminated by a zero. Line ends and tabs become
// \n, \r and \t; other characters that are not visible, and bytes that are not UTF-8, become \x1b
// and so on. A text that does not fit gets "..." in its middle. Quoting a quoted text changes
// nothing. `line` and `text` may be the same memory only if the text fits unchanged.
void quote_line(char *line, size_t size, const char *text);

// The same by value, for use within a call: fprintf(stderr, "%s: ...", quote(path).text).
Quoted quote(const char *text);
