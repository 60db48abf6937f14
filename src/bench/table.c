// SPDX-License-Identifier: MIT
#include "bench/table.h"
#include "base/bytes.h"
#include "base/json.h"
#include "bench/page.h"

#include "version.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

// --- The columns of the device, which are the same in every row.

typedef struct Device {
    const char *name, *value;
} Device;

enum { DEVICE_COUNT = 5 };

static const char *cpu_name(void)
{
    static char name[128] = "";
    char line[256];
    FILE *file = *name ? NULL : fopen("/proc/cpuinfo", "r");
    while (file && !*name && fgets(line, sizeof line, file)) {
        const char *colon = strchr(line, ':');
        if (strncmp(line, "model name", 10) == 0 && colon)
            snprintf(name, sizeof name, "%.*s", (int)strcspn(colon + 2, "\n"), colon + 2);
    }
    if (file) fclose(file);
    return name;
}

static void list_device(const Gpu *gpu, Device device[DEVICE_COUNT])
{
    device[0] = (Device){"renderer", gpu->renderer};
    device[1] = (Device){"gl_version", gpu->version};
    device[2] = (Device){"cpu", cpu_name()};
    device[3] = (Device){"version", TRACTRIX_VERSION};
    device[4] = (Device){"commit", TRACTRIX_COMMIT};
}

// --- Values. Column says which C type each kind has.

static const char *text_at(const Column *column, const void *row)
{
    const char *at = (const char *)row + column->place;
    return column->kind == COLUMN_CHARS ? at : *(const char *const *)(const void *)at;
}

static double real_at(const Column *column, const void *row)
{
    return *(const double *)(const void *)((const char *)row + column->place);
}

static long whole_at(const Column *column, const void *row)
{
    return *(const long *)(const void *)((const char *)row + column->place);
}

// Formats a value for the screen or (`precise`) for CSV. If `row` is NULL, writes the column's
// name.
static void format_value(const Column *column, const void *row, bool precise, char *text,
                         size_t size)
{
    if (!row)
        snprintf(text, size, "%s", column->name);
    else if (column->kind == COLUMN_WHOLE)
        snprintf(text, size, "%ld", whole_at(column, row));
    else if (column->kind == COLUMN_REAL && isnan(real_at(column, row)))
        *text = 0;
    else if (column->kind == COLUMN_REAL)
        snprintf(text, size, precise ? "%.9g" : "%.4g", real_at(column, row));
    else
        snprintf(text, size, "%s", text_at(column, row));
}

static void write_screen(const Table *table, const void *row)
{
    if (!table->screen) return;
    for (size_t i = 0; i < table->column_count; ++i) {
        const Column *column = &table->columns[i];
        char text[512];
        bool left = column->kind == COLUMN_TEXT || column->kind == COLUMN_CHARS;
        if (column->width == 0) continue;
        format_value(column, row, false, text, sizeof text);
        fprintf(table->screen, left ? "%s%-*s" : "%s%*s", i ? " " : "", column->width,
                *text ? text : "-");
    }
    fprintf(table->screen, "\n");
    fflush(table->screen);
}

static void write_csv(Table *table, const void *row)
{
    Device device[DEVICE_COUNT];
    list_device(table->gpu, device);
    for (size_t i = 0; i < table->column_count + DEVICE_COUNT; ++i) {
        char text[1024];
        const Device *own = i < table->column_count ? NULL : &device[i - table->column_count];
        if (own)
            snprintf(text, sizeof text, "%s", row ? own->value : own->name);
        else
            format_value(&table->columns[i], row, true, text, sizeof text);
        if (i) putc(',', table->csv_stream);
        for (const char *at = text; *at; ++at) putc(*at == ',' ? ';' : *at, table->csv_stream);
    }
    putc('\n', table->csv_stream);
}

static json_t *value_to_json(const Column *column, const void *row)
{
    switch (column->kind) {
    case COLUMN_WHOLE:
        return json_integer(whole_at(column, row));
    case COLUMN_REAL:
        return isfinite(real_at(column, row)) ? json_real(real_at(column, row)) : json_null();
    default:
        return json_string(text_at(column, row));
    }
}

// --- The table.

Result table_open(Table *table, const Column *columns, size_t column_count, const Gpu *gpu,
                  const TableOutput *output, FILE *screen, Error *error)
{
    *table = (Table){.columns = columns, .column_count = column_count, .gpu = gpu};
    table->output = *output, table->screen = screen;
    table->rows = json_array();
    table->csv_stream = open_memstream(&table->csv, &table->csv_size);
    if (!table->rows || !table->csv_stream)
        return error_set(error, RESULT_FAILED, "no memory for a table");
    write_screen(table, NULL);
    write_csv(table, NULL);
    return RESULT_OK;
}

void table_add(Table *table, const void *row)
{
    json_t *object = json_object();
    Device device[DEVICE_COUNT];
    write_screen(table, row);
    write_csv(table, row);
    list_device(table->gpu, device);
    for (size_t i = 0; i < table->column_count; ++i)
        json_object_set_new(object, table->columns[i].name, value_to_json(&table->columns[i], row));
    for (int i = 0; i < DEVICE_COUNT; ++i)
        json_object_set_new(object, device[i].name, json_string(device[i].value));
    json_array_append_new(table->rows, object);
}

// Counts a checked bound and keeps the message of the first broken one; `stated` is the text of
// the bound.
static const char *judge(Table *table, bool holds, double value, const char *stated,
                         const char *format, va_list arguments)
{
    char what[384];
    ++table->bounds;
    if (holds) return "holds";
    vsnprintf(what, sizeof what, format, arguments);
    if (table->broken++ == 0)
        snprintf(table->first_broken, sizeof table->first_broken, "%s: %.4g, stated is %s", what,
                 value, stated);
    return "broken";
}

const char *table_check(Table *table, double value, double most, const char *format, ...)
{
    char stated[64];
    va_list arguments;
    if (isnan(most)) return "";
    snprintf(stated, sizeof stated, "at most %g", most);
    va_start(arguments, format);
    const char *verdict = judge(table, value <= most, value, stated, format, arguments);
    va_end(arguments);
    return verdict;
}

const char *table_check_within(Table *table, double value, double least, double most,
                               const char *format, ...)
{
    char stated[64];
    va_list arguments;
    snprintf(stated, sizeof stated, "%g to %g", least, most);
    va_start(arguments, format);
    const char *verdict =
        judge(table, value >= least && value <= most, value, stated, format, arguments);
    va_end(arguments);
    return verdict;
}

// Writes the HTML page, with the kept rows as arrays in the order of the columns.
static Result write_page(const Table *table, Error *error)
{
    json_t *columns = json_array(), *rows = json_array();
    Device device[DEVICE_COUNT];
    list_device(table->gpu, device);
    for (size_t i = 0; i < table->column_count; ++i) {
        const Column *column = &table->columns[i];
        bool number = column->kind == COLUMN_WHOLE || column->kind == COLUMN_REAL;
        json_array_append_new(
            columns, page_column(column->name, number, column->width > 0 || !table->screen));
    }
    for (int i = 0; i < DEVICE_COUNT; ++i)
        json_array_append_new(columns, page_column(device[i].name, false, false));
    for (size_t row = 0; row < json_array_size(table->rows); ++row) {
        json_t *object = json_array_get(table->rows, row), *values = json_array();
        for (size_t i = 0; i < json_array_size(columns); ++i) {
            const char *name =
                json_string_value(json_object_get(json_array_get(columns, i), "name"));
            json_array_append(values, json_object_get(object, name));
        }
        json_array_append_new(rows, values);
    }
    Result result = page_write(table->output.html, table->output.title, table->output.command,
                               columns, rows, error);
    json_decref(columns);
    json_decref(rows);
    return result;
}

static Result write_files(Table *table, Error *error)
{
    const Bytes bytes = {.data = (uint8_t *)table->csv, .size = table->csv_size};
    if (table->output.csv) TRY(bytes_write_file(&bytes, table->output.csv, error));
    if (table->output.html) TRY(write_page(table, error));
    return table->output.json ? json_write_file(table->rows, table->output.json, error) : RESULT_OK;
}

Result table_close(Table *table, Result result, Error *error)
{
    bool whole = table->csv_stream && fclose(table->csv_stream) == 0;
    if (!whole) THEN(result, error_set(error, RESULT_FAILED, "no memory for the table"));
    // After a failed measurement the rows so far are written, but an existing file is not replaced
    // by an empty one.
    bool any = result == RESULT_OK || (result == RESULT_FAILED && json_array_size(table->rows));
    if (any && whole) {
        Error unwritten;
        Result written = write_files(table, &unwritten);
        if (written != RESULT_OK) result = error_set(error, written, "%s", unwritten.text);
    }
    if (table->broken)
        THEN(result, error_set(error, RESULT_FAILED, "%ld of %ld bounds are broken; the first: %s",
                               table->broken, table->bounds, table->first_broken));
    free(table->csv);
    json_decref(table->rows);
    *table = (Table){0};
    return result;
}

// --- Samples.

static int compare(const void *a, const void *b)
{
    double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

Times table_times(double *samples, int count)
{
    if (count == 0) return (Times){NAN, NAN, NAN, NAN};
    qsort(samples, (size_t)count, sizeof *samples, compare);
    return (Times){samples[0], samples[count / 4], samples[count / 2], samples[3 * count / 4]};
}

double table_slope(const double *x, const double *y, int count, double *spread)
{
    double u = 0, w = 0, uu = 0, uw = 0, ww = 0;
    for (int i = 0; i < count; ++i) {
        double a = log(x[i]), b = log(y[i]);
        u += a, w += b, uu += a * a, uw += a * b, ww += b * b;
    }
    *spread = NAN;
    if (count < 2) return 0;
    uu -= u * u / count, uw -= u * w / count, ww -= w * w / count;
    if (!(uu > 0)) return 0;
    if (count > 2) *spread = sqrt(fmax(ww - uw * uw / uu, 0) / (count - 2) / uu);
    return uw / uu;
}
