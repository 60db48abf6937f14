// SPDX-License-Identifier: MIT
// The files of a run: none that it writes may be one that it reads, or one that it writes under
// another flag.
#pragma once

#include "base/error.h"

typedef enum PathRole {
    PATH_READ,    // a file that is read, or a folder or pattern of them
    PATH_WRITTEN, // a file that is written, or a folder or pattern of numbered ones (target.h)
} PathRole;

typedef struct PathUse {
    const char *name; // for the message: "--cache", "the hair file"
    const char *path; // NULL or "": not used; "-": standard input or output, no file
    PathRole role;
} PathUse;

// Compares what is written with everything else: by identity where the file exists, so that links,
// spellings and a file system's case do not matter; else by folder and name, without regard to
// case. A pattern has every file that differs from it in the number alone. Devices and pipes may be
// used twice. RESULT_USAGE naming both uses; RESULT_FAILED naming an output whose file, or whose
// deepest folder that exists, cannot be written, or when memory is short.
Result paths_check(const PathUse *uses, int count, Error *error);
