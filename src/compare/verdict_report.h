// SPDX-License-Identifier: MIT
// What many verdicts come to: counts, the exit status, and reports for machines.
#pragma once

#include "compare/verdict.h"

typedef struct Tally {
    int pairs, updated;
    int outcomes[OUTCOME_COUNT]; // those updated, too
    int good;
    int worst; // the measured pair with the largest mean of FLIP, -1: none
    double flip;
} Tally;

// Counts `count` verdicts.
Tally verdict_count(const Verdict *verdicts, size_t count);

// RESULT_OK if all are good; RESULT_BAD_INPUT if a picture could not be read and is not replaced;
// else RESULT_FAILED.
Result verdict_status(const Verdict *verdicts, size_t count);

// The closing line.
void verdict_print_tally(const Tally *tally, const PairList *list, FILE *stream);

// A JSON object: limits, counts, and an object for each pair. RESULT_FAILED with path and reason.
Result verdict_write_json(const char *path, const PairList *list, const Verdict *verdicts,
                          const CompareLimits *limits, Error *error);

// JUnit's XML, a test case for each pair, as GitLab, Jenkins and others read it: unreadable
// pictures are errors, other bad verdicts failures. RESULT_FAILED with path and reason.
Result verdict_write_junit(const char *path, const PairList *list, const Verdict *verdicts,
                           Error *error);
