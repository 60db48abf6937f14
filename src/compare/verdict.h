// SPDX-License-Identifier: MIT
// One pair of pictures: read, compared, drawn, and the reference replaced if that is wanted.
#pragma once

#include "compare/pairs.h"
#include "image/compare.h"

#include <stdio.h>

typedef enum Outcome {
    OUTCOME_SAME,
    OUTCOME_DIFFERENT,  // beyond the limits
    OUTCOME_SIZES,      // of two sizes
    OUTCOME_MISSING,    // in one of two folders or sequences
    OUTCOME_UNREADABLE, // one of them
    OUTCOME_FAILED,     // no memory, a file can't be written: see the text
    OUTCOME_COUNT
} Outcome;

// "same", "different", "sizes", "missing", "unreadable", "failed".
extern const char *const OUTCOME_NAMES[OUTCOME_COUNT];

typedef struct Verdict {
    Outcome outcome;
    bool measured; // SAME and DIFFERENT: the figures hold
    CompareResult figures;
    bool updated;    // B took A's place: all is well now
    char text[1024]; // what else there is to say: why it is not the same
} Verdict;

typedef struct VerdictOptions {
    CompareLimits limits;
    const char *heat_map, *sheet; // file to write for this pair; NULL: none
    bool draw_same;               // not only for those that differ
    bool update;                  // copy B over A unless they are the same
} VerdictOptions;

// Never fails: what goes wrong is an outcome. B is copied byte for byte, complete or not at all,
// and only if it can be read as a picture; a reference without a new picture is left. Several
// threads may be in here at once.
void verdict_find(Verdict *verdict, const Pair *pair, const VerdictOptions *options);

// The verdict without "updated" is one that a test should fail for.
bool verdict_is_good(const Verdict *verdict);

// "NAME: same: RMSE ..." with an end of line.
void verdict_print(const Verdict *verdict, const Pair *pair, FILE *stream);
