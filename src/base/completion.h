// SPDX-License-Identifier: MIT
// Completion of a program's command line in bash, made from its flags as the help shows them.
#pragma once

#include <stddef.h>
#include <stdio.h>

// Writes a script for bash to read. A flag is "-j, --jobs N", "--raster auto|quads" or "--quiet":
// small words between bars behind it are offered as its values, FILE, DIR and PATH (whole or as an
// end) by the names of files, others not at all. What is no flag is a file's name.
void completion_write_bash(FILE *stream, const char *program, const char *const *flags,
                           size_t flag_count);
