// SPDX-License-Identifier: MIT
#include "base/error.h"

#include "base/quote.h"

#include <stdio.h>
#include <stdlib.h>

// Takes over and quotes the line. NULL means that there was no memory for it.
static void set_text(Error *error, char *line)
{
    if (line)
        quote_line(error->text, sizeof error->text, line);
    else
        snprintf(error->text, sizeof error->text, "no memory for a message");
    free(line);
}

Result(error_set)(Error *error, Result result, const char *format, ...)
{
    char *line = NULL;
    if (!error) return result;
    va_list arguments;
    va_start(arguments, format);
    if (vasprintf(&line, format, arguments) < 0) line = NULL;
    va_end(arguments);
    set_text(error, line);
    return result;
}

Result(error_prefix)(Error *error, Result result, const char *format, ...)
{
    char *prefix = NULL, *line = NULL;
    if (!error) return result;
    va_list arguments;
    va_start(arguments, format);
    if (vasprintf(&prefix, format, arguments) < 0) prefix = NULL;
    va_end(arguments);
    if (prefix && asprintf(&line, "%s%s", prefix, error->text) < 0) line = NULL;
    free(prefix);
    if (line) set_text(error, line);
    return result;
}
