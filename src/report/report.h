// SPDX-License-Identifier: MIT
// The room report: pages for people, one HTML file each, that need no network and no other file.
// It takes a JSON value and images, and hands on a page: page.html with the style and the script
// of all pages (page.css, page.js) and of its kind (compare.* or bench.*), the data as one block of
// JSON, the images behind it, each a block of base64 that the script decodes when it is looked at.
// picture.h makes images that browsers show, shell_words.h writes commands that a reader can copy.
//
// This file: the page. Its content security policy names the scripts and styles by their hashes and
// allows nothing from elsewhere, so no text of the data can become a script.
#pragma once

#include "base/bytes.h"
#include "base/error.h"
#include "base/outfile.h"

#include <jansson.h>
#include <stdbool.h>
#include <stdio.h>

// A file of src/report, embedded by scripts/embed-text. The table ends with zeros.
typedef struct ReportText {
    const char *name; // "page.css"
    const char *text;
    const char *hash; // SHA-256 in base64
} ReportText;
extern const ReportText REPORT_TEXTS[];

// A page that is being written. Its images wait in a scratch file, as the data stand before them.
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

// Adds the bytes of a PNG or JPEG file; *number is what the page's script knows it by, from 0 on.
// RESULT_FAILED if there is no room for it.
Result report_add_image(Report *report, const Bytes *file, int *number, Error *error);

// Leaves the image of this number out of the page.
void report_omit_image(Report *report, int number);

// Writes the page of `kind`, "compare" or "bench", with its data (no reference is taken; NULL:
// memory was short). The file appears complete or not at all; RESULT_FAILED with path and reason.
Result report_close(Report *report, const char *kind, const json_t *data, Error *error);

// Frees all and leaves no file. Legal for a zeroed report and after report_close.
void report_discard(Report *report);

// --- Values for the data.

// A string for any bytes: jansson takes only UTF-8, so bytes that are none become U+FFFD.
json_t *report_text(const char *text);

// The bytes as base64, for an image so small that it stands in the data; null for none.
json_t *report_base64(const Bytes *bytes);
