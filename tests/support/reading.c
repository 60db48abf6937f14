// SPDX-License-Identifier: MIT
#include "support/reading.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

Result reading_copy(Strands *strands, const void *data, size_t size,
                    const StrandsReadOptions *options, StrandsReport *report, Error *error)
{
    Bytes bytes = {malloc(size + 1), size};
    assert_non_null(bytes.data);
    memcpy(bytes.data, data, size);
    bytes.data[size] = 0;
    Result result = strands_read_bytes(strands, "FILE", &bytes, options, report, error);
    bytes_destroy(&bytes);
    return result;
}

Result reading_text(Strands *strands, const char *text, const StrandsReadOptions *options,
                    StrandsReport *report, Error *error)
{
    return reading_copy(strands, text, strlen(text), options, report, error);
}

const StrandsReadOptions METRES = {.unit = 1.0f};

Strands reading_good(const char *text, StrandsReport *report)
{
    Strands strands;
    Error error = {""};
    if (reading_text(&strands, text, &METRES, report, &error) != RESULT_OK)
        fail_msg("%s", error.text);
    return strands;
}
