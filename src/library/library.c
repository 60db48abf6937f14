// SPDX-License-Identifier: MIT
#include "library/library.h"

#include "base/parallel.h"

#include "version.h"

#include <stdarg.h>
#include <stdio.h>
#include <string.h>

_Static_assert((int)TRACTRIX_FAILED == (int)RESULT_FAILED &&
                   (int)TRACTRIX_NO_GL == (int)RESULT_NO_GL,
               "the same");

TractrixResult library_end(Result result, const Error *error, TractrixError *to)
{
    if (result != RESULT_OK && to) snprintf(to->text, sizeof to->text, "%s", error->text);
    return (TractrixResult)result;
}

TractrixResult library_refuse(TractrixError *to, const char *format, ...)
{
    TractrixError told;
    Error error;
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(told.text, sizeof told.text, format, arguments);
    va_end(arguments);
    error_set(&error, RESULT_USAGE, "%s", told.text);
    return library_end(RESULT_USAGE, &error, to);
}

Result library_take(void *to, size_t size, const void *from, size_t least, const char *name,
                    Error *error)
{
    size_t own = 0;
    if (!from) return error_set(error, RESULT_USAGE, "%s: got NULL", name);
    memcpy(&own, from, sizeof own);
    if (own < least || own > size)
        return error_set(error, RESULT_USAGE, "%s.size: got %zu, expected %zu to %zu", name, own,
                         least, size);
    memset(to, 0, size);
    memcpy(to, from, own);
    return RESULT_OK;
}

void library_give(void *to, const void *from)
{
    size_t own = 0;
    memcpy(&own, to, sizeof own);
    memcpy((char *)to + sizeof own, (const char *)from + sizeof own, own - sizeof own);
}

uint32_t tractrix_version_number(void)
{
    LIBRARY_CALL;
    return TRACTRIX_VERSION_NUMBER;
}

const char *tractrix_version(void)
{
    LIBRARY_CALL;
    return TRACTRIX_VERSION;
}

void tractrix_set_threads(int count)
{
    LIBRARY_CALL;
    parallel_set_threads(count);
}
