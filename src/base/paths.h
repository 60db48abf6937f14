// SPDX-License-Identifier: MIT
// The files of a run: none that it writes may be one that it reads, or one that it writes under
// another flag.
#pragma once

#include "base/error.h"

typedef enum PathRole {
    PATH_READ,    // a file that is read, or a folder or pattern of them
    PATH_WRITTEN, // a file that is written
    PATH_TARGET,  // a file that is written, or a folder or pattern of numbered ones (target.h)
    PATH_KEPT,    // a file that is written as it is, and may be read before
    PATH_FOLDER,  // a folder of files that are written
    PATH_UPDATED, // a file, folder or pattern that is read and then written
} PathRole;

typedef struct PathUse {
    const char *name; // for the message: "--cache", "the hair file"; outlives the claim
    const char *path; // NULL or "": not used; "-": standard input or output, no file
    PathRole role;
    const char *home; // the scene file that names this output, which must lie in that file's folder
                      // then, and links are not followed; NULL: anywhere
} PathUse;

// Compares what is written with everything else: by identity where the file exists, so that links,
// spellings and a file system's case do not matter; else by folder and name, without regard to
// case. A pattern has every file that differs from it in the number alone; files of that pattern
// that are links count where they lead. Devices and pipes may be used twice. RESULT_USAGE naming
// both uses; RESULT_BAD_INPUT naming an output that leaves its scene file's folder; RESULT_FAILED
// naming an output whose file, or whose deepest folder that exists, cannot be written, or when
// memory is short.
Result paths_check(const PathUse *uses, int count, Error *error);

// The same, and claims all uses (claims.h): outputs' paths are resolved here, once for the whole
// run. Single files are opened under a temporary name and missing folders are made, so that a
// folder that cannot be written to is reported before any work starts. Call it once per program,
// and outfile_end at the end. Fails like paths_check.
Result paths_claim(const PathUse *uses, int count, Error *error);
