// SPDX-License-Identifier: MIT
// The files that a run reads and writes, for the whole process: filled by paths_claim, used by
// outfile.h and bytes.h. All functions are thread-safe except claims_add and claims_end.
#pragma once

#include "base/place.h"

#include <stdbool.h>

// Files that the run writes under one path: one file, numbered files, or all files of a folder.
typedef struct Claim {
    const char *name;  // "--stats", for messages; must outlive the claim
    char *before;      // the path; of numbered files up to the number; owned
    char *after;       // of numbered files: the part after the number; NULL for one file; owned
    bool whole_folder; // all files whose path begins with `before`, which ends with a slash
    bool confined;     // links are not followed, and everything is within the folder `home`
    bool named;        // of a confined claim: the user, not a scene file, has named the folder
    struct stat home;
    Place place;   // of the file; of numbered files with any name; owned
    void *started; // used by outfile.h: the file that was opened in advance; NULL if none
} Claim;

// Takes over the claim and returns the stored one; NULL when memory is short (then nothing is taken
// over).
Claim *claims_add(const Claim *claim);

// The claim with exactly this path; NULL if there is none.
Claim *claims_find(const char *path);

// The next claim in their order; NULL returns the first one. Returns NULL after the last.
Claim *claims_next(const Claim *claim);

// Notes a file that the run reads. Does nothing without any claim (then outputs are unknown), and
// for files that are claimed: --resume and --update read what they write. When memory is short, the
// file is not noted.
void claims_note_input(const char *path, const struct stat *file);

// Notes a file that the run writes under this path.
void claims_note_output(const char *path, const struct stat *file);

// Whether the run reads this file, or has written it under another path than `path`. Then `other`
// receives that path, shortened to fit, and *written tells which case it is.
enum { CLAIMS_PATH_SIZE = 300 };
bool claims_find_other(char other[CLAIMS_PATH_SIZE], bool *written, const char *path,
                       const struct stat *file);

// Forgets everything, and removes folders that were made for claims and are still empty. Files
// opened in advance must have been discarded.
void claims_end(void);
