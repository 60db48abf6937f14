// SPDX-License-Identifier: MIT
// Verdicts as JUnit's XML, as GitLab, Jenkins and others read it.
#pragma once

#include "compare/verdict.h"

#include <time.h>

typedef struct JunitOptions {
    bool only_failures; // no cases for images that are the same
    double seconds;     // of the whole run
    time_t started;
} JunitOptions;

// A test case for each pair: unreadable and unrendered images are errors, other bad verdicts
// failures, with the sheet, the heat map, B and A as attachments if they are there, one a line:
// [[ATTACHMENT|path]], relative as in ci_path.h. RESULT_FAILED with path and reason.
Result junit_write(const char *path, const PairList *list, const Verdict *verdicts,
                   const JunitOptions *options, Error *error);
