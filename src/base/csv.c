// SPDX-License-Identifier: MIT
#include "base/csv.h"

#include <stdlib.h>
#include <string.h>

static size_t count_of(const char *text, char wanted)
{
    size_t count = 0;
    for (; *text; ++text) count += *text == wanted;
    return count;
}

// Cuts one line into fields in place; gives how many there were.
static size_t cut_line(char *line, char **fields, size_t most)
{
    size_t count = 0;
    for (char *rest = line; rest;) {
        char *field = strsep(&rest, ",");
        if (count < most) fields[count] = field;
        ++count;
    }
    return count;
}

static Result cut_lines(Csv *csv, Error *error)
{
    char *rest = (char *)csv->bytes.data;
    for (size_t number = 1; rest && *rest; ++number) {
        char *line = strsep(&rest, "\n");
        line[strcspn(line, "\r")] = 0;
        char **fields = number == 1 ? csv->column : &csv->field[csv->row_count * csv->column_count];
        size_t count = cut_line(line, fields, csv->column_count);
        if (count != csv->column_count)
            return error_set(error, RESULT_BAD_INPUT, "%s:%zu: %zu fields, the header has %zu",
                             csv->path, number, count, csv->column_count);
        csv->row_count += number > 1;
    }
    return RESULT_OK;
}

Result csv_read(Csv *csv, const char *path, Error *error)
{
    *csv = (Csv){.path = strdup(path)};
    Result result = bytes_read_file(&csv->bytes, path, error);
    if (result != RESULT_OK) return result;
    const char *text = (const char *)csv->bytes.data;
    size_t header = strcspn(text, "\n"), lines = count_of(text, '\n') + 1;
    csv->column_count = 1;
    for (size_t i = 0; i < header; ++i) csv->column_count += text[i] == ',';
    csv->column = calloc(csv->column_count, sizeof *csv->column);
    csv->field = calloc(lines * csv->column_count, sizeof *csv->field);
    if (!csv->path || !csv->column || !csv->field)
        return error_set(error, RESULT_FAILED, "%s: no memory", path);
    return cut_lines(csv, error);
}

void csv_destroy(Csv *csv)
{
    free(csv->path);
    free(csv->column);
    free(csv->field);
    bytes_destroy(&csv->bytes);
    *csv = (Csv){0};
}

Result csv_find(const Csv *csv, const char *name, size_t *column, Error *error)
{
    for (*column = 0; *column < csv->column_count; ++*column)
        if (csv->row_count > 0 && strcmp(csv->column[*column], name) == 0) return RESULT_OK;
    return error_set(error, RESULT_BAD_INPUT, "%s: no column '%s'", csv->path, name);
}

const char *csv_text(const Csv *csv, size_t row, size_t column)
{
    return csv->field[row * csv->column_count + column];
}

Result csv_number(const Csv *csv, size_t row, size_t column, double *value, Error *error)
{
    const char *text = csv_text(csv, row, column);
    char *end;
    *value = strtod(text, &end);
    if (end != text && *end == 0) return RESULT_OK;
    return error_set(error, RESULT_BAD_INPUT, "%s:%zu: %s: expected a number, got '%s'", csv->path,
                     row + 2, csv->column[column], text);
}
