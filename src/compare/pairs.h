// SPDX-License-Identifier: MIT
// The room compare: tractrix-compare. It pairs images or sequences of images (this file), judges
// each pair (verdict.h), and outputs lines, reports and an exit status (main_compare.c).
//
// This file: pairs of images: two files, or the files of two folders or of two numbered sequences.
#pragma once

#include "base/error.h"
#include "compare/levels.h"

#include <stdbool.h>
#include <stddef.h>

typedef struct Pair {
    char *name;        // displayed: the file's name in a folder or sequence, such as
                       // "walk/0001.png", otherwise b
    char *a, *b;       // paths of existing or missing files
    bool has_a, has_b; // whether they exist
    int frame;         // the number, in patterns
    char *mask;        // pixels that are compared (image/mask.h); NULL: all
    char *unrendered;  // why B could not be made; NULL: not given
    char *command;     // the command that made B; NULL: not given
    Level level;       // of A, for goldens by platform
    char *fallback;    // the golden that would apply without A, by platform; NULL: none
    bool not_for_gpus; // A is missing, and the golden for all platforms does not apply
} Pair;

typedef struct PairList {
    Pair *pairs; // in the order of names or numbers
    size_t count;
    bool by_platform;
    bool many; // folders or sequences, even with a single image
} PairList;

typedef struct PairOptions {
    bool create;            // A need not exist and is treated as an empty folder or sequence
    const char *mask;       // NULL: none; see below
    const char *unrendered; // file about images that could not be made; NULL: none
    const char *commands;   // file with commands that made the images; NULL: none
    const char *only;       // name of the only image, or pattern of images; NULL: all
    const char *platform;   // A is a folder of goldens by platform (levels.h), and this is the
                            // platform; NULL: it is not
    bool any_platform;      // goldens for all platforms also apply to GPUs
    Level update; // A has this level whether it exists or not; LEVEL_NONE: A is the first that
                  // exists
} PairOptions;

// `a` and `b` are both files; or both folders, whose visible .png, .pfm and .exr files are paired
// by name, also those in subfolders ("walk/0001.png"), as are .jpg and .jpeg files, which can't be
// compared; or both patterns with %d or %04d
// in the file's name, as for tractrix-render -o, whose files are paired by number. If only one of
// the two exists, the pair lacks the other. RESULT_USAGE for mixed kinds, RESULT_BAD_INPUT if a
// folder can't be read or there is no image at all. Files are not opened.
//
// A mask is a file for all pairs; a folder of masks with the names of images, with any suffix; or a
// pattern of masks with the images' numbers. RESULT_BAD_INPUT for a mask that matches no image,
// since a misnamed mask would have no effect.
//
// `unrendered` has lines "NAME: REASON", where NAME is an image's name or a pattern as above. Pairs
// of that name without B get the reason; if there is no such pair, one is added. `commands` has
// lines "NAME: COMMAND", and all pairs of that name get the command. Both are for folders only, and
// so is `only`, which must match a pair; masks may then match other images.
Result pairs_find(PairList *list, const char *a, const char *b, const PairOptions *options,
                  Error *error);
void pairs_destroy(PairList *list);
