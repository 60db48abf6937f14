// SPDX-License-Identifier: MIT
// Checks the files of a run: no output may be an input, or the output of another flag.
#pragma once

#include "base/error.h"

typedef enum PathRole {
    PATH_READ,    // a file that is read, or a folder or pattern of files
    PATH_WRITTEN, // a file that is written
    PATH_TARGET,  // a file that is written, or a folder or pattern of numbered files (target.h)
    PATH_KEPT,    // a file that is written in place and may be read before
    PATH_FOLDER,  // a folder of files that are written
    // A file, folder or pattern that is read and then written. Files of a folder or pattern must
    // stay in the folder, and links there are not followed.
    PATH_UPDATED,
} PathRole;

typedef struct PathUse {
    const char *name; // for messages: "--cache", "the hair file"; must outlive the claim
    const char *path; // NULL or "": not used; "-": standard input or output, not a file
    PathRole role;
    // The scene file that names this output. The output must then be in the scene file's folder,
    // and links are not followed. NULL: anywhere.
    const char *home;
} PathUse;

// Compares outputs with all other uses: by identity if the file exists, so that links, spellings
// and case-insensitive file systems do not matter; otherwise by folder and name, ignoring case. A
// pattern covers all files that differ only in the number; existing links among them are followed.
// Devices and pipes may be used twice. RESULT_USAGE with both uses; RESULT_BAD_INPUT with an output
// that leaves its scene file's folder; RESULT_FAILED with an output whose file, or whose deepest
// existing folder, cannot be written, or when memory is short.
Result paths_check(const PathUse *uses, int count, Error *error);

// The same, and claims all uses (claims.h): resolves the outputs' paths once for the whole run.
// Opens single files under a temporary name and makes missing folders, so that a folder that is not
// writable is reported before any work starts. Call it once per program, and outfile_end at the
// end. Errors of paths_check.
Result paths_claim(const PathUse *uses, int count, Error *error);
