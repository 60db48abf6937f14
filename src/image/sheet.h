// SPDX-License-Identifier: MIT
// A contact sheet: pictures of one size side by side, row by row, without gaps.
#pragma once

#include "image/image.h"

typedef struct Sheet {
    Image image;
    int columns, rows;
    int count; // tiles that are filled
} Sheet;

// Room for columns x rows tiles of this size and kind; those that are never filled are black, or
// transparent. RESULT_USAGE if the sheet has 1 GiB or more, RESULT_FAILED when memory is short.
// Destroying a zeroed struct is legal.
Result sheet_create(Sheet *sheet, int columns, int rows, const Image *tile, Error *error);
void sheet_destroy(Sheet *sheet);

// Fills the next tile, left to right and top to bottom. There must be one left.
void sheet_add(Sheet *sheet, const Image *tile);
