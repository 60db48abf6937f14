// SPDX-License-Identifier: MIT
// All that the programs write goes through here; nothing else in src opens a file to write it,
// renames, removes or makes a folder (tests/project/check_outputs). A path is resolved once, to a
// handle of its folder (place.h). A file appears complete or not at all. What the run has claimed
// (paths.h) was begun when it was claimed, and links of claims that are confined are not followed.
// No file is written that the run reads, or has written under another path: compared by device and
// inode.
#pragma once

#include "base/claims.h"
#include "base/error.h"
#include "base/leftovers.h"
#include "base/place.h"

#include <limits.h>
#include <stdbool.h>
#include <stdio.h>

// A file that is being written under a temporary name (".tractrix-...tmp") in its own folder.
typedef struct OutFile {
    FILE *stream;    // write here; write errors are sticky and found by outfile_commit
    char *path;      // as it was given
    Place place;     // of the final name, links followed
    char *temporary; // the present name in that folder; NULL for a device or pipe, which is written
                     // directly
    Leftover *leftover;
} OutFile;

// Whether the path is "-", which is standard output.
bool outfile_is_stdout(const char *path);

// RESULT_USAGE if `path` is standard output and that is a terminal: for binary data.
Result outfile_refuse_terminal(const char *path, Error *error);

// Creates the temporary file and the folders that its path lacks, or writes to standard output
// directly (permissions as for any new file, by the umask). RESULT_FAILED with path and reason: a
// folder that cannot be made, a folder of that name, an existing file that is read-only, ...;
// RESULT_USAGE for a file that the run reads or has written; RESULT_BAD_INPUT for a link where none
// is followed.
Result outfile_open(OutFile *file, const char *path, Error *error);

// The same, but nobody else may look into the folders that are made (mode 0700): for caches.
Result outfile_open_private(OutFile *file, const char *path, Error *error);

// Whether the file could be opened; leaves nothing but the folders that were missing. Fails like
// outfile_open.
Result outfile_try(const char *path, Error *error);

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

// Tries that a file can be made in the folder, which must be there. 0 or an errno.
int outfile_try_folder(const Place *place);

// Begins the one file that is claimed, so that outfile_open only hands it out. Nothing for devices
// and pipes. Fails like outfile_open.
Result outfile_start(Claim *claim, Error *error);

// For the end of a program: removes what was begun and never written, and ends all claims.
void outfile_end(void);

// --- Files that are not replaced as a whole.

// Opens a file for reading and writing as it is, or makes it and its folders: for files that grow
// over several runs. *descriptor is the caller's to close. Fails like outfile_open.
Result outfile_open_kept(int *descriptor, const char *path, Error *error);

// Appends the text to the file in one piece, so that texts of several processes do not mix; makes
// the file and its folders. Fails like outfile_open.
Result outfile_append(const char *path, const char *text, Error *error);

// Removes the file. Nothing if there is none; else RESULT_FAILED with path and reason.
Result outfile_remove(const char *path, Error *error);

// A file without a name, for what does not fit into memory; in the folder that the environment's
// TMPDIR names, or in /tmp. NULL with errno.
FILE *outfile_open_scratch(void);

// An empty file NAME-XXXXXX there, for a child process; removed by outfile_remove. RESULT_FAILED.
Result outfile_make_scratch(char path[PATH_MAX], const char *name, Error *error);

// The same with a folder, which goes with all that it has come to hold.
Result outfile_make_scratch_folder(char path[PATH_MAX], const char *name, Error *error);
void outfile_remove_scratch_folder(const char *path);
