// SPDX-License-Identifier: MIT
// The room report: self-contained HTML pages for people, which need no network and no other file.
// Input: a JSON value and images. Output: page.html with the style and script of all pages
// (page.css, page.js) and of its kind (compare.* or bench.*), the data as one JSON block, and each
// image as a base64 block after it, which the script decodes when it is viewed. picture.h converts
// images for browsers, shell_words.h writes commands for copying.
//
// This file: the page. Its content security policy lists scripts and styles by hash and allows
// nothing else, so no text of the data can run as a script.
#pragma once

#include "base/bytes.h"
#include "base/error.h"
#include "base/outfile.h"

#include <jansson.h>
#include <stdbool.h>
#include <stdio.h>

// A file of src/report, embedded by scripts/embed-text. The table is terminated by zeros.
typedef struct ReportText {
    const char *name; // "page.css"
    const char *text;
    const char *hash; // SHA-256 in base64
} ReportText;
extern const ReportText REPORT_TEXTS[];

// A page being written. The data must come before the images, so images wait in a scratch file.
typedef struct Report {
    OutFile file;
    FILE *images;
    struct ReportImage {
        long end; // of its block in the scratch file
        bool omitted;
    } * list;
    int image_count, room;
} Report;

// RESULT_FAILED with path and reason if the file cannot be written.
Result report_open(Report *report, const char *path, Error *error);

// Adds the bytes of a PNG or JPEG file; the page's script refers to it by *number, from 0.
// RESULT_FAILED if there is no room for it.
Result report_add_image(Report *report, const Bytes *file, int *number, Error *error);

// Omits the image with this number from the page.
void report_omit_image(Report *report, int number);

// Writes the page of `kind` ("compare" or "bench") with its data (takes no reference; NULL means
// that memory was short). The file appears complete or not at all; RESULT_FAILED with path and
// reason.
Result report_close(Report *report, const char *kind, const json_t *data, Error *error);

// Frees everything and leaves no file. May be called for a zeroed report and after report_close.
void report_discard(Report *report);

// --- Values for the data.

// A string from any bytes. jansson accepts only UTF-8, so invalid bytes become U+FFFD.
json_t *report_text(const char *text);

// The bytes as base64, for an image small enough to be part of the data; null if there are none.
json_t *report_base64(const Bytes *bytes);
