// SPDX-License-Identifier: MIT
// Verdicts as GitHub Actions shows them: annotations of files, and a summary of the job.
#pragma once

#include "compare/verdict.h"

// A workflow command "::error file=A,title=NAME%3A different::FIGURES" for each bad verdict. GitHub
// shows ten errors a step: from the tenth on, one command counts what is left.
void github_print_annotations(const PairList *list, const Verdict *verdicts, FILE *stream);

// Appends counts, limits and a table of bad and updated images in Markdown to the file that
// $GITHUB_STEP_SUMMARY names; nothing if it is not set. RESULT_FAILED with path and reason.
Result github_append_summary(const PairList *list, const Verdict *verdicts,
                             const CompareLimits limits[LEVELS], Error *error);
