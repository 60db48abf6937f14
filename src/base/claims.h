// SPDX-License-Identifier: MIT
// What a run reads and writes, known to the whole process: filled by paths_claim, asked by
// outfile.h and bytes.h. All functions may be called from any thread, but for claims_add and
// claims_end.
#pragma once

#include "base/place.h"

#include <stdbool.h>

// Files that the run writes, by one path: one file, numbered ones, or all of a folder.
typedef struct Claim {
    const char *name;  // "--stats", for messages; outlives the claim
    char *before;      // the path, of numbered ones up to the number; owned
    char *after;       // of numbered ones: behind the number; NULL: one file; owned
    bool whole_folder; // any file whose path begins with `before`, which ends with a slash
    bool confined;     // links are not followed, and all lies in the folder `home`
    struct stat home;
    Place place;   // of the file, of numbered ones with any name; owned
    void *started; // outfile.h's: the file, which is begun before it is written; NULL: none
} Claim;

// Takes the claim over. Returns the kept one; NULL when memory is short: then nothing is taken.
Claim *claims_add(const Claim *claim);

// The claim of this very path, letter by letter; NULL: none.
Claim *claims_find(const char *path);

// The claims in their order: NULL: the first; returns NULL behind the last.
Claim *claims_next(const Claim *claim);

// Notes a file that the run reads. Nothing without any claim (then nobody has said what is
// written), and for files that are claimed: --resume and --update read what they write. When memory
// is short the file is not noted.
void claims_note_input(const char *path, const struct stat *file);

// Notes a file that the run has written or writes, by this path.
void claims_note_output(const char *path, const struct stat *file);

// Whether the run reads this very file, or has written it as another output than `path`: then
// `other` is the path of that, shortened to fit, and *written says which of the two.
enum { CLAIMS_PATH_SIZE = 300 };
bool claims_find_other(char other[CLAIMS_PATH_SIZE], bool *written, const char *path,
                       const struct stat *file);

// Forgets everything, and removes folders that were made for claims and are still empty. Files that
// were started must have been discarded.
void claims_end(void);
