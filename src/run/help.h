// SPDX-License-Identifier: MIT
// What tractrix-render says about itself, all made from the parameter table.
#pragma once

#include <stdio.h>

// The text of --help, at most 96 columns wide.
void help_write_text(FILE *stream);

// The man page, section 1, in roff; `version` is the program's.
void help_write_man(FILE *stream, const char *version);

// docs/options.md in Markdown: flags, one table per group, and what else a scene file has.
void help_write_markdown(FILE *stream);

// Completion of the flags and their values in bash.
void help_write_bash(FILE *stream);
