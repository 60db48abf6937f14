// SPDX-License-Identifier: MIT
// The command "page" (bench_commands.h): shows rows of CSV files as an HTML page.
#include "base/csv.h"
#include "bench/bench_commands.h"
#include "bench/page.h"
#include "report/report.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

typedef struct Rows {
    json_t *columns, *rows;
} Rows;

static bool is_number(const char *text, double *value)
{
    char *end;
    *value = strtod(text, &end);
    return end != text && !*end && isfinite(*value);
}

// Whether a column names the machine or the build. These columns stay text, because a commit may
// look like a number.
static bool is_text(const char *name)
{
    static const char *const NAMES[] = {"renderer", "gl_version", "cpu", "version", "commit", NULL};
    const char *const *at = NAMES;
    while (*at && strcmp(*at, name) != 0) ++at;
    return *at;
}

// The index of the page's column with this name; a new column is added if there is none.
static size_t find_column(Rows *rows, const char *name)
{
    size_t count = json_array_size(rows->columns), i = 0;
    json_t *text = report_text(name);
    while (i < count &&
           !json_equal(json_object_get(json_array_get(rows->columns, i), "name"), text))
        ++i;
    if (i == count) json_array_append_new(rows->columns, page_column(name, !is_text(name), true));
    json_decref(text);
    return i;
}

// A column is numeric if each of its fields is a number or empty.
static void look_at_column(json_t *column, const Csv *csv, size_t place)
{
    double value;
    for (size_t row = 0; row < csv->row_count; ++row) {
        const char *field = csv_text(csv, row, place);
        if (*field && !is_number(field, &value))
            json_object_set_new(column, "number", json_false());
    }
}

static void add_row(Rows *rows, const Csv *csv, size_t row, const size_t *places)
{
    json_t *values = json_array();
    for (size_t i = 0; i < csv->column_count; ++i) {
        const char *field = csv_text(csv, row, i);
        while (json_array_size(values) <= places[i]) json_array_append_new(values, json_null());
        if (*field) json_array_set_new(values, places[i], report_text(field));
    }
    json_array_append_new(rows->rows, values);
}

static Result add_file(Rows *rows, const char *path, Error *error)
{
    Csv csv;
    TRY(csv_read(&csv, path, error));
    size_t *places = calloc(csv.column_count, sizeof *places);
    Result result =
        places ? RESULT_OK : error_set(error, RESULT_FAILED, "%s: no memory for its rows", path);
    for (size_t i = 0; result == RESULT_OK && i < csv.column_count; ++i) {
        places[i] = find_column(rows, csv.column[i]);
        look_at_column(json_array_get(rows->columns, places[i]), &csv, i);
    }
    for (size_t row = 0; result == RESULT_OK && row < csv.row_count; ++row)
        add_row(rows, &csv, row, places);
    free(places);
    csv_destroy(&csv);
    return result;
}

// Converts texts to numbers in numeric columns, and adds the missing columns to each row.
static void finish_rows(Rows *rows)
{
    size_t count = json_array_size(rows->columns);
    for (size_t row = 0; row < json_array_size(rows->rows); ++row) {
        json_t *values = json_array_get(rows->rows, row);
        while (json_array_size(values) < count) json_array_append_new(values, json_null());
        for (size_t i = 0; i < count; ++i) {
            const char *text = json_string_value(json_array_get(values, i));
            double value;
            if (text && is_number(text, &value) &&
                json_is_true(json_object_get(json_array_get(rows->columns, i), "number")))
                json_array_set_new(values, i, json_real(value));
        }
    }
}

Result page_run(const BenchOptions *options, const Gpu *gpu, Error *error)
{
    (void)gpu;
    const TableOutput *output = &options->output;
    if (!output->html || !options->file_count || output->csv || output->json)
        return error_set(error, RESULT_USAGE,
                         "page: expected FILE.csv... and --html FILE.html, and no --csv or --json");
    Rows rows = {json_array(), json_array()};
    Result result = RESULT_OK;
    for (int i = 0; i < options->file_count; ++i)
        THEN(result, add_file(&rows, options->files[i], error));
    finish_rows(&rows);
    THEN(result,
         page_write(output->html, output->title, output->command, rows.columns, rows.rows, error));
    json_decref(rows.columns);
    json_decref(rows.rows);
    return result;
}
