// SPDX-License-Identifier: MIT
// Verdicts in the form of GitHub Actions: annotations of files, and a job summary.
#pragma once

#include "compare/verdict.h"

// Prints a workflow command "::error file=A,title=NAME%3A different::FIGURES" for each bad verdict.
// GitHub shows ten errors per step, so the tenth command gives the number of the remaining ones.
void github_print_annotations(const PairList *list, const Verdict *verdicts, FILE *stream);

// Appends counts, limits and a table of bad and updated images in Markdown to the file
// $GITHUB_STEP_SUMMARY; nothing if it is not set. RESULT_FAILED with path and reason.
Result github_append_summary(const PairList *list, const Verdict *verdicts,
                             const CompareLimits limits[LEVELS], Error *error);
