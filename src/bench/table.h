// SPDX-License-Identifier: MIT
// Rows of results: one description of columns produces the lines on the screen, the CSV file, the
// JSON file and the page. Also statistics of samples: quartiles of times, slopes in log-log plots.
#pragma once

#include "base/error.h"
#include "gpu/gpu.h"

#include <jansson.h>
#include <stddef.h>
#include <stdio.h>

typedef enum ColumnKind {
    COLUMN_TEXT,  // const char *; "" is "-" on the screen
    COLUMN_CHARS, // char[]
    COLUMN_WHOLE, // long
    COLUMN_REAL,  // double; NaN: no value ("-" on the screen, empty in CSV, null in JSON)
} ColumnKind;

typedef struct Column {
    const char *name; // on the screen and in files
    ColumnKind kind;
    size_t place; // offset in the caller's row
    int width;    // on the screen, in characters; 0: not shown there
} Column;

// A row's struct and its columns from one list ROW(X), which has X(KIND, name, width) for each
// column:
#define TABLE_FIELD(kind, name, width)  TABLE_FIELD_##kind(name)
#define TABLE_FIELD_TEXT(name)          const char *name;
#define TABLE_FIELD_CHARS(name)         char name[TABLE_CHARS];
#define TABLE_FIELD_WHOLE(name)         long name;
#define TABLE_FIELD_REAL(name)          double name;
#define TABLE_COLUMN(kind, name, width) {#name, COLUMN_##kind, offsetof(Row, name), width},
// The arguments of table_open for these columns.
#define TABLE_COLUMNS COLUMNS, sizeof COLUMNS / sizeof *COLUMNS
enum { TABLE_CHARS = 1152 };

// Where rows are written besides the screen; zeroed: to no files.
typedef struct TableOutput {
    const char *json, *csv, *html; // files; NULL: none
    const char *title, *command;   // of the page
} TableOutput;

// table_open fills some members; the others are zeroed.
typedef struct Table {
    const Column *columns;
    size_t column_count;
    const Gpu *gpu;
    TableOutput output;
    FILE *screen;
    json_t *rows;
    char *csv; // the file's text, by open_memstream
    size_t csv_size;
    FILE *csv_stream;
    long bounds, broken; // checked by table_check, and how many of them are broken
    char first_broken[512];
} Table;

// Prints the head. `columns` and `gpu` must outlive the table. `screen` NULL: the caller prints
// rows itself. RESULT_FAILED when memory is short.
Result table_open(Table *table, const Column *columns, size_t column_count, const Gpu *gpu,
                  const TableOutput *output, FILE *screen, Error *error);

// Prints a row at once and keeps it for the files, which also have the device's columns renderer,
// gl_version, cpu, version and commit. (CSV fields have no quotes: commas in texts become
// semicolons.)
void table_add(Table *table, const void *row);

// Checks that `value` is at most `most` (NaN is not) and counts the result; the message is for the
// first broken bound. Returns the text for a column of verdicts: "holds", "broken", or "" if `most`
// is NaN.
const char *table_check(Table *table, double value, double most, const char *format, ...)
    __attribute__((format(printf, 4, 5)));

// The same for a value that must be at least `least` and at most `most`.
const char *table_check_within(Table *table, double value, double least, double most,
                               const char *format, ...) __attribute__((format(printf, 5, 6)));

// Writes the files unless `result`, the result of the measurements, is a failure other than
// RESULT_FAILED; frees everything. RESULT_FAILED if a bound is broken or a file can't be written.
Result table_close(Table *table, Result result, Error *error);

// Quartiles of samples, ms.
typedef struct Times {
    double minimum, lower_quartile, median, upper_quartile;
} Times;

// Sorts `count` samples in place; NaN if there are none.
Times table_times(double *samples, int count);

// The slope of log(y) against log(x) by least squares, for `count` points with positive numbers; 0
// if there are less than two different x. *spread: its standard error; NaN for less than three
// points.
double table_slope(const double *x, const double *y, int count, double *spread);
