// SPDX-License-Identifier: MIT
// The room compare: tractrix-compare. It takes images or sequences of them, pairs them (this file),
// judges each pair (verdict.h), and hands on lines, reports and an exit status (main_compare.c).
//
// This file: which images belong together: two files, or those of two folders or of two numbered
// sequences.
#pragma once

#include "base/error.h"
#include "compare/levels.h"

#include <stdbool.h>
#include <stddef.h>

typedef struct Pair {
    char *name;        // for people: the file's name in a folder or sequence, else b
    char *a, *b;       // where both are, or would be
    bool has_a, has_b; // whether they were found
    int frame;         // its number, in patterns
    char *mask;        // which pixels are compared (image/mask.h); NULL: all
    char *unrendered;  // why B could not be made; NULL: nobody says so
    char *command;     // what made B; NULL: nobody says so
    Level level;       // which A is, of goldens by platform
    char *fallback;    // the golden that would count without A, by platform; NULL: none
    bool not_for_gpus; // A is missing, but there is one of all platforms, which does not count
} Pair;

typedef struct PairList {
    Pair *pairs; // in the order of names or numbers
    size_t count;
    bool by_platform;
    bool many; // folders or sequences, though they may have one image
} PairList;

typedef struct PairOptions {
    bool create;            // A need not exist: it is what B is, and empty
    const char *mask;       // NULL: none; see below
    const char *unrendered; // file of images that could not be made; NULL: none
    const char *commands;   // file of what makes the images; NULL: none
    const char *only;       // name of the only image, or pattern of them; NULL: all
    const char *platform;   // A is a folder of goldens by platform (levels.h), sought for this one;
                            // NULL: it is not
    bool any_platform;      // goldens of all count for GPUs, too
    Level update;           // A is at this level whether it is there or not; LEVEL_NONE: A is what
                            // is found first
} PairOptions;

// `a` and `b` are both files; or both folders, whose files ending in .png, .pfm or .exr (not
// hidden) go by name, as .jpg and .jpeg do, which cannot be compared; or both patterns with %d or
// %04d in the file's name, as tractrix-render -o takes them, whose files go by number. What only
// one has is a pair with the other missing. RESULT_USAGE for mixed kinds, RESULT_BAD_INPUT if a
// folder can't be read or there is no image at all. Files are not opened.
//
// A mask is a file for all pairs; a folder of masks for the images of the same name, whatever the
// suffix; or a pattern of masks for the images of the same number. RESULT_BAD_INPUT for a mask that
// belongs to no image, as a wrong name would be a mask without effect.
//
// `unrendered` has lines "NAME: REASON"; NAME is an image's name or a pattern as above. Pairs of
// that name without a B get the reason; where there are none, NAME becomes a pair. `commands` has
// lines "NAME: COMMAND", and all pairs of that name get it. Both are for folders only, as is
// `only`, of which one pair must be; a mask may then belong to another image.
Result pairs_find(PairList *list, const char *a, const char *b, const PairOptions *options,
                  Error *error);
void pairs_destroy(PairList *list);
