// SPDX-License-Identifier: MIT
// What programs say about themselves, laid out for a terminal or as a manual page.
#pragma once

#include <stddef.h>
#include <stdio.h>

// Words of `text` from `column` on, wrapped at 96 columns, and a line's end; every line but the
// first is indented to `indent`. What stands in [brackets] stays on one line.
void prose_write_wrapped(FILE *stream, const char *text, size_t column, size_t indent);

// A flag in the left column and its text in the right one, below it if the flag is long.
void prose_write_entry(FILE *stream, const char *flag, const char *text);

// A line of roff, with what roff would take for its own escaped: backslashes, hyphens of flags, and
// a control character at the begin.
void prose_write_roff(FILE *stream, const char *text);

// A tagged paragraph of roff.
void prose_write_roff_entry(FILE *stream, const char *tag, const char *text);

// A heading of roff: macro "SH" or "SS".
void prose_write_roff_heading(FILE *stream, const char *macro, const char *title);
