// SPDX-License-Identifier: MIT
// The comparison as an HTML page (report.h): pairs with their images, metrics and limits.
#pragma once

#include "compare/verdict.h"
#include "report/report.h"

// One image of a pair on the page.
typedef struct HtmlSide {
    Bytes png;     // empty: no image
    Bytes small;   // a JPEG for viewing; empty: the PNG is smaller, or has transparency
    json_t *facts; // size, depth, texts of the file, or why it is missing
} HtmlSide;
typedef struct HtmlPair {
    HtmlSide side[2];
    bool equal; // pixel by pixel: only the second side's image is included
    Bytes map;  // for VerdictOptions
    Bytes thumbnail;
} HtmlPair;

// Reads the files of a pair, before --update changes them. Never fails: the facts state what can't
// be read. May be called by several threads at once.
void html_pair_read(HtmlPair *page, const Pair *pair);
void html_pair_destroy(HtmlPair *page);

// The page. A zeroed page may be discarded.
typedef struct Html {
    Report report;
    json_t *pairs;
    struct HtmlChoice *choices; // PNG or JPEG for pairs that differ
    size_t choice_count;
} Html;

// RESULT_FAILED with path and reason.
Result html_open(Html *html, const char *path, Error *error);

// Appends a pair.
Result html_add(Html *html, const Pair *pair, const Verdict *verdict, const HtmlPair *page,
                Error *error);

// Writes the file, completely or not at all. `command` is the command line, for the reader.
Result html_close(Html *html, const PairList *list, const CompareLimits limits[LEVELS],
                  const char *command, Error *error);
void html_discard(Html *html);
