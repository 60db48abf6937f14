// SPDX-License-Identifier: MIT
// Whole files: read at once, or written so that they appear complete or not at all.
#pragma once

#include "error.h"

#include <limits.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>

// The bytes of a file. `data` has one more byte, zero, behind `size`, so that text may be read as a
// string.
typedef struct Bytes {
    uint8_t *data;
    size_t size;
} Bytes;

// Reads all of `path` ("-" is not special; pipes and devices are read until they end). Fails with
// RESULT_BAD_INPUT naming the path and the reason (missing, a folder, unreadable), or RESULT_FAILED
// when memory is short. Free with bytes_destroy, which takes a zeroed struct too.
Result bytes_read_file(Bytes *bytes, const char *path, Error *error);
void bytes_destroy(Bytes *bytes);

// A file that is being written under a temporary name (".tractrix-...tmp") in the folder of `path`.
typedef struct OutFile {
    FILE *stream;    // write here; write errors are sticky and found by outfile_commit
    char *path;      // the final name, links followed
    char *temporary; // the present name; NULL for a device or pipe, which is written directly
} OutFile;

// Creates the temporary file (permissions as for any new file, by the umask). RESULT_FAILED with
// path and reason: no such folder, a folder of that name, an existing file that is read-only, ...
Result outfile_open(OutFile *file, const char *path, Error *error);

// Flushes, syncs to disk, closes and renames to the final name; on any failure the temporary file
// is removed, an older file of the final name is left as it was, and the reason is given (disk
// full, ...). `file` is zeroed.
Result outfile_commit(OutFile *file, Error *error);

// Closes and removes the temporary file. Legal for a zeroed struct, so `outfile_discard` may follow
// any outcome.
void outfile_discard(OutFile *file);

// Writes the bytes as a whole file through the three above: complete or not at all, RESULT_FAILED
// with path and reason.
Result bytes_write_file(const Bytes *bytes, const char *path, Error *error);

// A template for mkstemp or mkdtemp: NAME-XXXXXX in the folder that the environment's TMPDIR names,
// or in /tmp.
void file_scratch_name(char path[PATH_MAX], const char *name);
