// SPDX-License-Identifier: MIT
// Plain CSV: a header line with column names, comma-separated fields without quotes.
#pragma once

#include "base/bytes.h"
#include "base/error.h"

#include <stddef.h>
#include <stdio.h>

// A table in memory. `field[row * column_count + column]` points into `bytes`.
typedef struct Csv {
    char *path;
    Bytes bytes;
    char **field; // row 0 is the first after the header
    char **column;
    size_t column_count, row_count;
} Csv;

// Reads the file. RESULT_BAD_INPUT with "FILE:LINE: ..." if a row has a different number of fields
// than the header. After a failure *csv is zero.
Result csv_read(Csv *csv, const char *path, Error *error);
void csv_destroy(Csv *csv);

// The column with this name; RESULT_BAD_INPUT with file and column if it is missing.
Result csv_find(const Csv *csv, const char *name, size_t *column, Error *error);

// The field as in the file; valid until csv_destroy.
const char *csv_text(const Csv *csv, size_t row, size_t column);

// A number, decimal or C hexadecimal. RESULT_BAD_INPUT with "FILE:LINE: ..." if the field is not a
// number.
Result csv_number(const Csv *csv, size_t row, size_t column, double *value, Error *error);
