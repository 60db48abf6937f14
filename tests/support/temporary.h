// SPDX-License-Identifier: MIT
// A folder for a test's files, below TMPDIR or /tmp.
#pragma once

#include <stdbool.h>
#include <stddef.h>

typedef struct Temporary {
    char folder[256];
} Temporary;

// cmocka set-up and tear-down. *state is a Temporary; the folder is removed with its content.
int temporary_create(void **state);
int temporary_destroy(void **state);

// The path of `name` in the folder. The last eight results are valid.
const char *temporary_path(void **state, const char *name);

// The number of files in `path`, with hidden files and folders, but without the content of folders.
// -1: there is no such folder.
int temporary_count_files(const char *path);

// Whether there is a file with this name in the folder.
bool temporary_has(void **state, const char *name);

// Writes a text file with the given mode.
void temporary_write(void **state, const char *name, const char *text, unsigned mode);
