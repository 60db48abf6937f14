// SPDX-License-Identifier: MIT
#include "bench/page.h"

#include "report/report.h"

#include "version.h"

json_t *page_column(const char *name, bool number, bool shown)
{
    json_t *column = json_object();
    json_object_set_new(column, "name", report_text(name));
    json_object_set_new(column, "number", json_boolean(number));
    json_object_set_new(column, "shown", json_boolean(shown));
    return column;
}

Result page_write(const char *path, const char *title, const char *command, const json_t *columns,
                  const json_t *rows, Error *error)
{
    Report report;
    TRY(report_open(&report, path, error));
    json_t *data = json_object();
    json_object_set_new(data, "program", json_string("tractrix-bench " TRACTRIX_VERSION));
    json_object_set_new(data, "title", report_text(title));
    json_object_set_new(data, "command", report_text(command));
    json_object_set_new(data, "columns", json_deep_copy(columns));
    json_object_set_new(data, "rows", json_deep_copy(rows));
    Result result = report_close(&report, "bench", data, error);
    json_decref(data);
    return result;
}
