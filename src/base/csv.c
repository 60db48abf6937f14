// SPDX-License-Identifier: MIT
#include "base/csv.h"

#include <stdlib.h>
#include <string.h>

static size_t count_of(const char *text, const char *end, char wanted)
{
    size_t count = 0;
    for (; text < end; ++text) count += *text == wanted;
    return count;
}

// Splits the lines into fields, in place.
static Result cut_lines(Csv *csv, Error *error)
{
    char *rest = (char *)csv->bytes.data;
    for (size_t number = 1; rest && *rest; ++number) {
        char *line = strsep(&rest, "\n");
        line[strcspn(line, "\r")] = 0;
        char **fields = number == 1 ? csv->column : &csv->field[csv->row_count * csv->column_count];
        size_t count = 0;
        while (line) {
            char *field = strsep(&line, ",");
            if (count < csv->column_count) fields[count] = field;
            ++count;
        }
        if (count != csv->column_count)
            return error_set(error, RESULT_BAD_INPUT,
                             "%s:%zu: %zu fields: expected %zu, as in the header", csv->path,
                             number, count, csv->column_count);
        csv->row_count += number > 1;
    }
    return RESULT_OK;
}

static Result read_file(Csv *csv, const char *path, Error *error)
{
    *csv = (Csv){.path = strdup(path)};
    TRY(bytes_read_file(&csv->bytes, path, error));
    bytes_drop_mark(&csv->bytes);
    const char *text = (const char *)csv->bytes.data, *end = text + csv->bytes.size;
    if (!*text)
        return error_set(error, RESULT_BAD_INPUT,
                         "%s: is empty: expected a line with the names of the columns", path);
    csv->column_count = count_of(text, text + strcspn(text, "\n"), ',') + 1;
    size_t lines = count_of(text, end, '\n') + 1;
    csv->column = calloc(csv->column_count, sizeof *csv->column);
    csv->field = calloc(lines * csv->column_count, sizeof *csv->field);
    if (!csv->path || !csv->column || !csv->field)
        return error_set(error, RESULT_FAILED, "%s: no memory", path);
    return cut_lines(csv, error);
}

Result csv_read(Csv *csv, const char *path, Error *error)
{
    Result result = read_file(csv, path, error);
    if (result != RESULT_OK) csv_destroy(csv);
    return result;
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
    return error_set(error, RESULT_BAD_INPUT, "%s:%zu: %s: got '%s', expected a number", csv->path,
                     row + 2, csv->column[column], text);
}
