// SPDX-License-Identifier: MIT
// All output of the programs goes through here; no other file in src opens files for writing,
// renames or removes files, or makes folders (tests/project/check_outputs). A path is resolved
// once, to a handle of its folder (place.h). A file appears complete or not at all. Files claimed
// by the run (paths.h) were opened when they were claimed, and links are not followed for confined
// claims. A file that the run reads, or has written under another path, is never overwritten; files
// are compared by device and inode.
#pragma once

#include "base/claims.h"
#include "base/error.h"
#include "base/leftovers.h"
#include "base/place.h"

#include <limits.h>
#include <stdbool.h>
#include <stdio.h>

// A file being written under a temporary name (".tractrix-...tmp") in its own folder.
typedef struct OutFile {
    FILE *stream; // write errors are sticky; outfile_commit reports them
    char *path;   // as given
    Place place;  // of the final name, after following links
    // The temporary name in the folder; NULL for a device or pipe, which is written directly.
    char *temporary;
    Leftover *leftover;
} OutFile;

// How often a folder that another run removes at the same time is made again.
enum { OUTFILE_TRIES = 20 };

// Why an output that a scene file names is refused, for messages that begin with its place.
#define OUTFILE_ALLOWS     "expected --allow-paths, or the path on the command line"
#define OUTFILE_IS_OUTSIDE "is outside the scene file's folder: " OUTFILE_ALLOWS
#define OUTFILE_IS_LINK                                                                            \
    "is a symbolic link, which outputs of a scene file do not follow: " OUTFILE_ALLOWS
#define OUTFILE_IS_NO_FILE                                                                         \
    "is a device or a pipe, to which a scene file may not write: " OUTFILE_ALLOWS

// Why a pipe or device is refused in the place of a numbered file, a file of a folder or a cache.
#define OUTFILE_IS_STREAM "cannot write: is a device or a pipe: expected a plain file"

// Whether the path is "-", standard output.
bool outfile_is_stdout(const char *path);

// RESULT_USAGE if `path` is standard output and that is a terminal; for binary data.
Result outfile_refuse_terminal(const char *path, Error *error);

// Creates the temporary file and missing folders, with permissions by the umask, or opens standard
// output directly. RESULT_FAILED with path and reason: a folder cannot be made, a folder has that
// name, an existing file is read-only, ...; RESULT_USAGE for a file that the run reads or has
// written; RESULT_BAD_INPUT for a link, device or pipe that an output of a scene file must not be;
// RESULT_FAILED for a device or pipe under the name of a numbered file or a file of a folder.
Result outfile_open(OutFile *file, const char *path, Error *error);

// The same for caches: new folders are accessible only to the user (mode 0700), and a link is not
// followed: RESULT_FAILED.
Result outfile_open_private(OutFile *file, const char *path, Error *error);

// Checks that the file can be opened. Leaves nothing but folders that were missing. Errors of
// outfile_open.
Result outfile_try(const char *path, Error *error);

// Flushes the output so far. RESULT_FAILED with path and reason if a write failed; then only
// outfile_discard may follow.
Result outfile_check(OutFile *file, Error *error);

// Flushes and syncs to disk, so that outfile_commit need not wait. Errors of outfile_check.
Result outfile_sync(OutFile *file, Error *error);

// Flushes, syncs to disk, closes and renames to the final name. On failure the temporary file is
// removed, an existing file with the final name stays unchanged, and the reason is given (disk
// full, ...). Zeroes `file`.
Result outfile_commit(OutFile *file, Error *error);

// Closes and removes the temporary file. Accepts a zeroed struct, so it may follow any outcome.
void outfile_discard(OutFile *file);

// Checks that a file can be created in the folder, which must exist. Returns 0 or an errno.
int outfile_try_folder(const Place *place);

// Opens the one file of a claim in advance; outfile_open then returns it. Does nothing for devices
// and pipes. Errors of outfile_open.
Result outfile_start(Claim *claim, Error *error);

// At the end of a program: removes files that were opened in advance and never written, and ends
// all claims.
void outfile_end(void);

// --- Files that are written in place.

// Opens a file in place for reading and writing, or creates it and its folders, for files that grow
// over several runs. The caller closes *descriptor. Errors of outfile_open.
Result outfile_open_kept(int *descriptor, const char *path, Error *error);

// Appends the text to the file in one write, so that texts of several processes do not mix. Creates
// the file and its folders. Errors of outfile_open.
Result outfile_append(const char *path, const char *text, Error *error);

// Removes the file, if it exists; otherwise does nothing. RESULT_FAILED with path and reason.
Result outfile_remove(const char *path, Error *error);

// A file without a name, for data that does not fit into memory, in the folder TMPDIR or in /tmp.
// NULL with errno.
FILE *outfile_open_scratch(void);

// An empty file NAME-XXXXXX in that folder, for a child process; remove it with outfile_remove.
// RESULT_FAILED.
Result outfile_make_scratch(char path[PATH_MAX], const char *name, Error *error);

// The same for a folder, which is removed with its content.
Result outfile_make_scratch_folder(char path[PATH_MAX], const char *name, Error *error);
void outfile_remove_scratch_folder(const char *path);
