// SPDX-License-Identifier: MIT
// Rows of results: one description of the columns makes the lines on the screen, the CSV file, the
// JSON file and the page. Beside it what sums up samples: quartiles of times, slopes of logarithms.
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
    COLUMN_REAL,  // double; NaN: there is none ("-" on the screen, empty in CSV, null in JSON)
} ColumnKind;

typedef struct Column {
    const char *name; // in all three
    ColumnKind kind;
    size_t place; // offset in the caller's row
    int width;    // on the screen, in characters; 0: not shown there
} Column;

// A row's struct and its columns from one list, ROW(X) with X(KIND, name, width) for each column:
//     typedef struct Row { ROW(TABLE_FIELD) } Row;
//     static const Column COLUMNS[] = {ROW(TABLE_COLUMN)};
#define TABLE_FIELD(kind, name, width)  TABLE_FIELD_##kind(name)
#define TABLE_FIELD_TEXT(name)          const char *name;
#define TABLE_FIELD_CHARS(name)         char name[TABLE_CHARS];
#define TABLE_FIELD_WHOLE(name)         long name;
#define TABLE_FIELD_REAL(name)          double name;
#define TABLE_COLUMN(kind, name, width) {#name, COLUMN_##kind, offsetof(Row, name), width},
// What table_open takes of them.
#define TABLE_COLUMNS COLUMNS, sizeof COLUMNS / sizeof *COLUMNS
enum { TABLE_CHARS = 1152 };

// Where rows go. A zeroed one goes nowhere but the screen.
typedef struct TableOutput {
    const char *json, *csv, *html; // files; NULL: none
    const char *title, *command;   // of the page
} TableOutput;

// Zeroed but for what table_open fills.
typedef struct Table {
    const Column *columns;
    size_t column_count;
    const Gpu *gpu;
    TableOutput output;
    FILE *screen;
    json_t *rows;
    char *csv; // its text, made by open_memstream
    size_t csv_size;
    FILE *csv_stream;
    long bounds, broken; // checked by table_check, and how many of them did not hold
    char first_broken[512];
} Table;

// Prints the head. `columns` and `gpu` outlive the table. `screen` NULL: the caller prints in its
// own way. RESULT_FAILED when memory is short.
Result table_open(Table *table, const Column *columns, size_t column_count, const Gpu *gpu,
                  const TableOutput *output, FILE *screen, Error *error);

// Prints a row at once and keeps it for the files, where it also has the device's columns:
// renderer, gl_version, cpu, version and commit. (CSV fields have no quotes: a comma in a text
// becomes a semicolon.)
void table_add(Table *table, const void *row);

// Whether `value` is at most `most` (a NaN is not), counted; the message names the first that is
// not. Returns the word for a column of verdicts: "holds", "broken", and "" where `most` is NaN.
const char *table_check(Table *table, double value, double most, const char *format, ...)
    __attribute__((format(printf, 4, 5)));

// The same for a value that must be at least `least` and at most `most`.
const char *table_check_within(Table *table, double value, double least, double most,
                               const char *format, ...) __attribute__((format(printf, 5, 6)));

// Writes the files unless `result`, that of the measurements, is a failure other than
// RESULT_FAILED; frees all. RESULT_FAILED if a bound is broken or a file cannot be written.
Result table_close(Table *table, Result result, Error *error);

// Of some samples, ms.
typedef struct Times {
    double minimum, lower_quartile, median, upper_quartile;
} Times;

// Sorts `count` samples in place; NaN for none.
Times table_times(double *samples, int count);

// The slope of log(y) against log(x), least squares, of `count` points with positive numbers; 0 for
// less than two different x. *spread: its standard error; NaN for less than three points.
double table_slope(const double *x, const double *y, int count, double *spread);
