// SPDX-License-Identifier: MIT
// Path-traced cases of light in hair: a folder of scenes for tractrix-render, NAME.json, each with
// the path tracer's image in blocks of 8 x 8 pixels, NAME.csv. Also the difference of our images
// from it.
//
// Columns of the CSV file: column, row (from the top left), one_r, one_g, one_b (linear radiance
// with single scattering), all_r, all_g, all_b (with every bounce), coverage (share of the pixels
// that hair covers). Each block has one line, in any order.
#pragma once

#include "base/error.h"
#include "image/image.h"

enum { LIGHT_BLOCK_PX = 8 };

typedef enum LightTable { LIGHT_ONE, LIGHT_ALL, LIGHT_COVERAGE, LIGHT_TABLES } LightTable;

typedef struct LightCase {
    char *name;                        // file name without folder and suffix
    char *scene, *table;               // paths of the two files
    int columns, rows;                 // number of blocks
    double (*blocks[LIGHT_TABLES])[3]; // [rows * columns]; coverage as three equal numbers
} LightCase;

typedef struct LightCases {
    LightCase *list; // in alphabetical order
    size_t count;
} LightCases;

// Reads every case of a folder, or those of the comma-separated list `names` (NULL: all). Scenes
// are not opened. Reports JSON files without a CSV file on standard error. RESULT_BAD_INPUT with
// one line: no such folder, no cases in it, an invalid file; RESULT_USAGE for a name that the
// folder lacks. May be destroyed in either case.
Result light_cases_read(LightCases *cases, const char *folder, const char *names, Error *error);
void light_cases_destroy(LightCases *cases);

// Writes the table of a case from the path tracer's images with single scattering and with every
// bounce: IMAGE_FLOATs of 4 channels, the last of which is the coverage, of whole blocks.
// RESULT_FAILED with path and reason.
Result light_case_write(const char *path, const Image *one, const Image *all, Error *error);

// Difference of an image from the path tracer's, by channel. `mean`: ratio of the image's mean to
// the tracer's; `rel`: RMS of the difference of blocks, relative to the RMS of the tracer's blocks.
typedef struct LightError {
    double mean[3], rel[3];
} LightError;

// `image` is an IMAGE_FLOAT whose size is the case's blocks times LIGHT_BLOCK_PX.
LightError light_case_compare(const LightCase *lit, LightTable table, const Image *image);

// The block's mean in each channel of the image.
void light_case_block(const Image *image, int column, int row, double *mean);
