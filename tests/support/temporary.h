// SPDX-License-Identifier: MIT
// A folder for a test's files, below TMPDIR or /tmp.
#pragma once

#include <stdbool.h>
#include <stddef.h>

typedef struct Temporary {
    char folder[256];
} Temporary;

// cmocka set-up and tear-down: *state is a Temporary; the folder goes with all that is in it.
int temporary_create(void **state);
int temporary_destroy(void **state);

// The path of `name` in the folder. Up to eight results are valid at a time.
const char *temporary_path(void **state, const char *name);

// How many files, hidden ones too, lie in `path`, folders included but not what is in them. -1: no
// such folder.
int temporary_count_files(const char *path);

// Whether there is a file of that name in the folder.
bool temporary_has(void **state, const char *name);

// Writes a text as a file, with the mode given.
void temporary_write(void **state, const char *name, const char *text, unsigned mode);
