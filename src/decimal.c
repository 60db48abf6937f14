// SPDX-License-Identifier: MIT
#include "decimal.h"

#include <stdlib.h>
#include <string.h>

void decimal_put(FILE *stream, const char *before, float value)
{
    char text[40];
    for (int digits = 6; digits <= 9; digits++) {
        snprintf(text, sizeof text, "%.*g", digits, (double)value);
        if (strtof(text, NULL) == value) break;
    }
    // What stands between the digits is the locale's decimal separator, of one or more bytes.
    size_t whole = strspn(text, "+-0123456789einfa");
    size_t separator = strcspn(text + whole, "0123456789");
    fprintf(stream, "%s%.*s", before, (int)whole, text);
    if (text[whole]) fprintf(stream, ".%s", text + whole + separator);
}
