// SPDX-License-Identifier: MIT
// Rows as an HTML page (report.h): a table, and plots of its numbers.
#pragma once

#include "base/error.h"

#include <jansson.h>
#include <stdbool.h>

// A column of the page: its name, whether it has numbers, whether the screen shows it too.
json_t *page_column(const char *name, bool number, bool shown);

// Writes the page. `columns`: of page_column; `rows`: arrays of as many numbers, texts or nulls;
// `title`: the heading; `command`: the command line that made it. Takes no references.
// RESULT_FAILED with path and reason.
Result page_write(const char *path, const char *title, const char *command, const json_t *columns,
                  const json_t *rows, Error *error);
