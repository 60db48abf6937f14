// SPDX-License-Identifier: MIT
#include "base/prose.h"

#include <ctype.h>
#include <stdbool.h>
#include <string.h>

enum { WIDTH = 96, COLUMN = 30 };

void prose_write_wrapped(FILE *stream, const char *text, size_t column, size_t indent)
{
    bool first = true;
    while (*text) {
        size_t length = *text == '[' ? strcspn(text, "]") + 1 : strcspn(text, " ");
        if (!first && column + 1 + length > WIDTH) {
            fprintf(stream, "\n%*s", (int)indent, "");
            column = indent;
            first = true;
        }
        fprintf(stream, "%s%.*s", first ? "" : " ", (int)length, text);
        column += length + (first ? 0 : 1);
        first = false;
        text += length;
        text += strspn(text, " ");
    }
    fputc('\n', stream);
}

void prose_write_entry(FILE *stream, const char *flag, const char *text)
{
    int used = fprintf(stream, "  %s", flag);
    if (used > COLUMN - 2) {
        fputc('\n', stream);
        used = 0;
    }
    fprintf(stream, "%*s", COLUMN - used, "");
    prose_write_wrapped(stream, text, COLUMN, COLUMN);
}

void prose_write_roff(FILE *stream, const char *text)
{
    if (*text == '.' || *text == '\'') fputs("\\&", stream);
    for (; *text; text++) {
        if (*text == '\\')
            fputs("\\e", stream);
        else if (*text == '-')
            fputs("\\-", stream);
        else
            fputc(*text, stream);
    }
    fputc('\n', stream);
}

void prose_write_roff_entry(FILE *stream, const char *tag, const char *text)
{
    fprintf(stream, ".TP\n.B ");
    prose_write_roff(stream, tag);
    prose_write_roff(stream, text);
}

void prose_write_roff_heading(FILE *stream, const char *macro, const char *title)
{
    fprintf(stream, ".%s \"", macro);
    for (; *title; title++) fputc(toupper((unsigned char)*title), stream);
    fprintf(stream, "\"\n");
}
