// SPDX-License-Identifier: MIT
// Reads, compares and draws one pair of images, and replaces the reference if requested; and sums
// up the verdicts on all pairs.
#pragma once

#include "base/bytes.h"
#include "compare/pairs.h"
#include "image/compare.h"

#include <jansson.h>
#include <stdio.h>

typedef enum Outcome {
    OUTCOME_SAME,       // no visible difference
    OUTCOME_WITHIN,     // different, but within the limits
    OUTCOME_DIFFERENT,  // beyond the limits
    OUTCOME_SIZES,      // different sizes
    OUTCOME_NEW,        // A is missing
    OUTCOME_MISSING,    // B is missing
    OUTCOME_UNRENDERED, // B could not be made: see the text
    OUTCOME_UNREADABLE, // A, B or the mask
    OUTCOME_FAILED,     // no memory, a file can't be written: see the text
    OUTCOME_COUNT
} Outcome;

typedef struct Verdict {
    Outcome outcome;
    bool measured; // SAME, WITHIN and DIFFERENT: `figures` are valid
    CompareResult figures;
    bool exact;         // the limits did not count: see VerdictOptions.exact_if_alike
    bool mask_is_wrong; // the reason for UNREADABLE
    bool updated;       // B replaced A, or A was left to the fallback: the pair is no longer bad
    bool dropped;       // A was removed or not written, because it equals the pair's fallback
    char text[1024];    // details if the outcome does not explain itself
    char *heat_map;     // written files, owned; NULL: none
    char *sheet;
    double seconds; // time taken
} Verdict;

typedef struct VerdictOptions {
    CompareLimits limits;
    bool exact_if_alike; // images with the same texts Renderer, Driver and CPU must be equal
    const char *heat_map, *sheet; // file to write for this pair; NULL: none
    bool draw_all;                // draw also if the images are not different
    bool update;                  // copy B over A unless it is good
    const Mask *mask;             // a mask for all pairs, already read; NULL: reads each pair's
    Bytes *map;                   // receives the heat map as PNG if a pixel differs; NULL: none
} VerdictOptions;

// Never fails: errors are outcomes. B is copied byte for byte, completely or not at all, and only
// if it can be read as an image; a reference without a new image is kept. A golden by platform that
// equals its fallback, pixel by pixel, is removed or not written. May be called by several threads
// at once.
void verdict_find(Verdict *verdict, const Pair *pair, const VerdictOptions *options);
void verdict_destroy(Verdict *verdict);

// Same, within the limits, or updated.
bool verdict_is_good(const Verdict *verdict);

// Whether lists of failures contain the pair: it is not good, or has been updated.
bool verdict_is_listed(const Verdict *verdict);

// "same", "within limits", "size mismatch", ...
const char *verdict_word(const Verdict *verdict);

// Names, outcome and metrics as an object; and the limits, for goldens by platform as one object
// per level.
json_t *verdict_to_json(const Verdict *verdict, const Pair *pair);
json_t *verdict_limits_to_json(const CompareLimits limits[LEVELS], const PairList *list);

// "NAME: same: RMSE ..." with an end of line.
void verdict_print(const Verdict *verdict, const Pair *pair, FILE *stream);

// --- All pairs: verdicts [list->count].

typedef struct VerdictTally {
    int outcomes[OUTCOME_COUNT]; // including updated ones
    int updated, bad;
    int errors;      // of the bad ones: unreadable or unrendered
    bool flip_known; // of all measured pairs
    int worst;       // the measured pair with the largest mean FLIP, or the largest RMSE if
                     // !flip_known; -1: none
} VerdictTally;

VerdictTally verdict_tally(const PairList *list, const Verdict *verdicts);

// RESULT_OK if all are good; RESULT_BAD_INPUT if an image could not be read and is
// not replaced; otherwise RESULT_FAILED.
Result verdict_status(const PairList *list, const Verdict *verdicts);

// The last line: counts, and the largest mean FLIP or RMSE.
void verdict_print_tally(const PairList *list, const Verdict *verdicts, FILE *stream);

// A JSON object: limits, counts, and an object for each pair; with `only_failures` for each pair
// for which verdict_is_listed is true. RESULT_FAILED with path and reason.
Result verdict_write_json(const char *path, const PairList *list, const Verdict *verdicts,
                          const CompareLimits limits[LEVELS], bool only_failures, Error *error);
