// SPDX-License-Identifier: MIT
#include "base/error.h"

#include <stdio.h>
#include <string.h>

Result error_set(Error *error, Result result, const char *format, ...)
{
    if (!error) return result;
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(error->text, sizeof error->text, format, arguments);
    va_end(arguments);
    return result;
}

Result error_prefix(Error *error, Result result, const char *format, ...)
{
    if (!error) return result;
    Error whole;
    va_list arguments;
    va_start(arguments, format);
    int length = vsnprintf(whole.text, sizeof whole.text, format, arguments);
    va_end(arguments);
    if (length < 0) return result;
    if ((size_t)length < sizeof whole.text)
        snprintf(whole.text + length, sizeof whole.text - (size_t)length, "%s", error->text);
    *error = whole;
    return result;
}
