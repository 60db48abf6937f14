// SPDX-License-Identifier: MIT
// Rows of results: one description of the columns makes the lines on the screen, the CSV file and
// the JSON file.
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

// Where rows go. A zeroed one goes nowhere but the screen.
typedef struct BenchOutput {
    const char *json, *csv; // files; NULL: none
} BenchOutput;

// Zeroed but for what bench_table_open fills.
typedef struct BenchTable {
    const Column *columns;
    size_t column_count;
    const Gpu *gpu;
    BenchOutput output;
    FILE *screen;
    json_t *rows;
    char *csv; // its text, made by open_memstream
    size_t csv_size;
    FILE *csv_stream;
    long bounds, broken; // checked by bench_table_check, and how many of them did not hold
    char first_broken[512];
} BenchTable;

// Prints the head. `columns` and `gpu` outlive the table. `screen` NULL: the caller prints in its
// own way. RESULT_FAILED when memory is short.
Result bench_table_open(BenchTable *table, const Column *columns, size_t column_count,
                        const Gpu *gpu, const BenchOutput *output, FILE *screen, Error *error);

// Prints a row at once and keeps it for the files, where it also has the device's columns:
// renderer, gl_version, cpu, version and commit. (CSV fields have no quotes: a comma in a text
// becomes a semicolon.)
void bench_table_add(BenchTable *table, const void *row);

// Whether `value` is at most `most` (a NaN is not), counted; the message names the first that is
// not. The words are for a column of verdicts: "holds", "broken", and "" where `most` is NaN.
const char *bench_table_check(BenchTable *table, double value, double most, const char *format, ...)
    __attribute__((format(printf, 4, 5)));

// Writes the files unless `result`, what the measuring came to, is a failure other than
// RESULT_FAILED; frees all. RESULT_FAILED if a bound is broken or a file cannot be written.
Result bench_table_close(BenchTable *table, Result result, Error *error);
