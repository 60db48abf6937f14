// SPDX-License-Identifier: MIT
// Path-traced cases of light in hair: a folder of NAME.json, scenes as tractrix-render reads them,
// each with NAME.csv beside it, which has the path tracer's image in blocks of 8 x 8 pixels. Also
// how far an image of ours is from one.
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
    char *name;                        // of its files, without folder and suffix
    char *scene, *table;               // their paths
    int columns, rows;                 // of blocks
    double (*blocks[LIGHT_TABLES])[3]; // [rows * columns]; coverage has three equal numbers
} LightCase;

typedef struct LightCases {
    LightCase *list; // in alphabetical order
    size_t count;
} LightCases;

// Reads every case of a folder, or those that `names` lists with commas between them (NULL: all).
// Scenes are not opened. Says on standard error which JSON files have no CSV file beside them.
// RESULT_BAD_INPUT with one line: no such folder, no cases in it, a file that is wrong;
// RESULT_USAGE for a name that the folder lacks. May be destroyed in either case.
Result light_cases_read(LightCases *cases, const char *folder, const char *names, Error *error);
void light_cases_destroy(LightCases *cases);

// How far an image is from the tracer's, by channel. `mean`: its mean over that of the tracer;
// `rel`: RMS of the difference of blocks over the RMS of the tracer's blocks.
typedef struct LightError {
    double mean[3], rel[3];
} LightError;

// `image` is an IMAGE_FLOAT of the case's blocks times LIGHT_BLOCK_PX.
LightError light_case_compare(const LightCase *lit, LightTable table, const Image *image);

// The block's mean in each channel.
void light_case_block(const Image *image, int column, int row, double mean[3]);
