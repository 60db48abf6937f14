// SPDX-License-Identifier: MIT
// The comparison as a page for people (report.h): pairs with their images, figures and limits.
#pragma once

#include "compare/verdict.h"
#include "report/report.h"

// What the page shows of a pair.
typedef struct HtmlSide {
    Bytes png;     // empty: there is no image
    Bytes small;   // a JPEG for looking at; empty: the PNG is smaller, or has transparency
    json_t *facts; // size, depth, texts of the file, or why there is none
} HtmlSide;
typedef struct HtmlPair {
    HtmlSide side[2];
    bool equal; // pixel by pixel: one image, that of the second side, is enough
    Bytes map;  // for VerdictOptions
    Bytes thumbnail;
} HtmlPair;

// Reads the files of a pair, before --update changes them. Never fails: what can't be read is a
// fact. May be called from several threads at once.
void html_pair_read(HtmlPair *page, const Pair *pair);
void html_pair_destroy(HtmlPair *page);

// The page. Zeroed, it may be discarded.
typedef struct Html {
    Report report;
    json_t *pairs;
    struct HtmlChoice *choices; // between PNG and JPEG of pairs that differ
    size_t choice_count;
} Html;

// RESULT_FAILED with path and reason.
Result html_open(Html *html, const char *path, Error *error);

// Adds a pair behind those that were added.
Result html_add(Html *html, const Pair *pair, const Verdict *verdict, const HtmlPair *page,
                Error *error);

// Writes the file: complete or not at all. `command` is the command line, for the reader.
Result html_close(Html *html, const PairList *list, const CompareLimits limits[LEVELS],
                  const char *command, Error *error);
void html_discard(Html *html);
