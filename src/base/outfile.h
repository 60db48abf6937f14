// SPDX-License-Identifier: MIT
// A file that appears complete or not at all.
#pragma once

#include "base/error.h"
#include "base/leftovers.h"

#include <limits.h>
#include <stdbool.h>
#include <stdio.h>

// A file that is being written under a temporary name (".tractrix-...tmp") in the folder of `path`.
typedef struct OutFile {
    FILE *stream;    // write here; write errors are sticky and found by outfile_commit
    char *path;      // the final name, links followed
    char *temporary; // the present name; NULL for a device or pipe, which is written directly
    Leftover *leftover;
} OutFile;

// Whether the path is "-", which is standard output.
bool outfile_is_stdout(const char *path);

// RESULT_USAGE if `path` is standard output and that is a terminal: for binary data.
Result outfile_refuse_terminal(const char *path, Error *error);

// Creates the temporary file and the folders that its path lacks, or writes to standard output
// directly (permissions as for any new file, by the umask). RESULT_FAILED with path and reason: a
// folder that cannot be made, a folder of that name, an existing file that is read-only, ...
Result outfile_open(OutFile *file, const char *path, Error *error);

// Flushes what has been written so far. RESULT_FAILED with path and reason if a write failed; then
// only outfile_discard may follow.
Result outfile_check(OutFile *file, Error *error);

// Flushes and syncs to disk, so that outfile_commit need not wait for that. Fails like
// outfile_check.
Result outfile_sync(OutFile *file, Error *error);

// Flushes, syncs to disk, closes and renames to the final name; on any failure the temporary file
// is removed, an older file of the final name is left as it was, and the reason is given (disk
// full, ...). `file` is zeroed.
Result outfile_commit(OutFile *file, Error *error);

// Closes and removes the temporary file. Legal for a zeroed struct, so `outfile_discard` may follow
// any outcome.
void outfile_discard(OutFile *file);

// A template for mkstemp or mkdtemp: NAME-XXXXXX in the folder that the environment's TMPDIR names,
// or in /tmp.
void outfile_scratch_name(char path[PATH_MAX], const char *name);
