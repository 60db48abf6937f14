// SPDX-License-Identifier: MIT
// One pair of images: read, compared, drawn, and the reference replaced if that is wanted; and what
// the verdicts on all pairs come to.
#pragma once

#include "base/bytes.h"
#include "compare/pairs.h"
#include "image/compare.h"

#include <jansson.h>
#include <stdio.h>

typedef enum Outcome {
    OUTCOME_SAME,
    OUTCOME_DIFFERENT,  // beyond the limits
    OUTCOME_SIZES,      // of two sizes
    OUTCOME_NEW,        // there is no A
    OUTCOME_MISSING,    // there is no B
    OUTCOME_UNRENDERED, // B could not be made: see the text
    OUTCOME_UNREADABLE, // one of them, or the mask
    OUTCOME_FAILED,     // no memory, a file can't be written: see the text
    OUTCOME_COUNT
} Outcome;

typedef struct Verdict {
    Outcome outcome;
    bool measured; // SAME and DIFFERENT: the figures hold
    CompareResult figures;
    bool mask_is_wrong; // the reason for UNREADABLE
    bool updated;       // B took A's place, or is left to the fallback: all is well now
    bool dropped;       // A was removed or not written: the pair's fallback is equal to it
    char text[1024];    // why it is not the same, if the outcome needs more words
    char *heat_map;     // files that were written, owned; NULL: none
    char *sheet;
    double seconds; // that it took
} Verdict;

typedef struct VerdictOptions {
    CompareLimits limits;
    const char *heat_map, *sheet; // file to write for this pair; NULL: none
    bool draw_same;               // not only for those that differ
    bool update;                  // copy B over A unless they are the same
    const Mask *mask;             // that of all pairs, already read; NULL: read each pair's
    Bytes *map;                   // takes the heat map as PNG if a pixel differs; NULL: none
} VerdictOptions;

// Never fails: what goes wrong is an outcome. B is copied byte for byte, complete or not at all,
// and only if it can be read as an image; a reference without a new image is left. A golden by
// platform that is equal to its fallback, pixel by pixel, is removed or not written. May be called
// from several threads at once.
void verdict_find(Verdict *verdict, const Pair *pair, const VerdictOptions *options);
void verdict_destroy(Verdict *verdict);

// Same or updated.
bool verdict_is_good(const Verdict *verdict);

// "same", "size mismatch", ...
const char *verdict_word(const Verdict *verdict);

// Names, outcome and figures as an object; and the limits: of goldens by platform an object for
// each level's.
json_t *verdict_to_json(const Verdict *verdict, const Pair *pair);
json_t *verdict_limits_to_json(const CompareLimits limits[LEVELS], const PairList *list);

// "NAME: same: RMSE ..." with an end of line.
void verdict_print(const Verdict *verdict, const Pair *pair, FILE *stream);

// --- Of all pairs: verdicts [list->count].

typedef struct VerdictTally {
    int outcomes[OUTCOME_COUNT]; // those updated, too
    int updated, bad;
    int errors; // of the bad ones: unreadable or unrendered
    int worst;  // the measured pair with the largest mean of FLIP, -1: none
} VerdictTally;

VerdictTally verdict_tally(const PairList *list, const Verdict *verdicts);

// RESULT_OK if all are the same or updated; RESULT_BAD_INPUT if an image could not be read and is
// not replaced; else RESULT_FAILED.
Result verdict_status(const PairList *list, const Verdict *verdicts);

// The closing line: counts, and the largest mean of FLIP.
void verdict_print_tally(const PairList *list, const Verdict *verdicts, FILE *stream);

// A JSON object: limits, counts, and an object for each pair; with `only_failures` for each that is
// not the same. RESULT_FAILED with path and reason.
Result verdict_write_json(const char *path, const PairList *list, const Verdict *verdicts,
                          const CompareLimits limits[LEVELS], bool only_failures, Error *error);
