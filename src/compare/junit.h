// SPDX-License-Identifier: MIT
// Verdicts in JUnit's XML format, which GitLab, Jenkins and others read.
#pragma once

#include "compare/verdict.h"

#include <time.h>

typedef struct JunitOptions {
    bool only_failures; // no cases for images that pass
    double seconds;     // of the whole run
    time_t started;
} JunitOptions;

// A test case for each pair: unreadable and unrendered images are errors, other bad verdicts are
// failures, with the existing ones of sheet, heat map, B and A as attachments, one per line:
// [[ATTACHMENT|path]], relative as in ci_path.h. RESULT_FAILED with path and reason.
Result junit_write(const char *path, const PairList *list, const Verdict *verdicts,
                   const JunitOptions *options, Error *error);
