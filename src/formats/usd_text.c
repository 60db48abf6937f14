// SPDX-License-Identifier: MIT
#include "formats/usd_text.h"

#include <ctype.h>
#include <stdlib.h>
#include <string.h>

char usd_text_here(const Reader *reader)
{
    return reader_ok(reader) ? (char)reader->data[reader->at] : 0;
}

void usd_text_step(Reader *reader)
{
    reader->line += usd_text_here(reader) == '\n';
    reader->at += usd_text_here(reader) != 0;
}

// Skips "/* ... */".
static void skip_comment(Reader *reader)
{
    for (int i = 0; i < 2; ++i) usd_text_step(reader);
    while (usd_text_here(reader) &&
           !(usd_text_here(reader) == '*' && reader->data[reader->at + 1] == '/'))
        usd_text_step(reader);
    if (!usd_text_here(reader)) reader_fail(reader, "a comment is not closed: expected */");
    for (int i = 0; i < 2; ++i) usd_text_step(reader);
}

char usd_text_peek(Reader *reader, bool line)
{
    for (;;) {
        char c = usd_text_here(reader);
        char next = c == '/' ? (char)reader->data[reader->at + 1] : 0;
        if (c == '#' || next == '/')
            while (usd_text_here(reader) && usd_text_here(reader) != '\n') usd_text_step(reader);
        else if (next == '*')
            skip_comment(reader);
        else if (c == ' ' || c == '\t' || c == '\r' || c == ';' || (c == '\n' && !line))
            usd_text_step(reader);
        else
            return c;
    }
}

bool usd_text_take(Reader *reader, char wanted)
{
    if (usd_text_peek(reader, false) != wanted) return false;
    usd_text_step(reader);
    return true;
}

void usd_text_expect(Reader *reader, char wanted)
{
    if (!reader_ok(reader) || usd_text_take(reader, wanted)) return;
    reader_fail(reader,
                usd_text_here(reader) ? "expected '%c'" : "expected '%c', got the end of the file",
                wanted);
}

bool usd_text_is_letter(char c)
{
    return isalnum((unsigned char)c) || (c && strchr("_:.+-", c)) || (c & 0x80);
}

static void read_text(Reader *reader, char word[USD_WORD_SIZE], bool brackets)
{
    size_t length = 0;
    char c = usd_text_peek(reader, false);
    for (; usd_text_is_letter(c) || (brackets && (c == '[' || c == ']'));
         c = usd_text_here(reader)) {
        if (length < USD_WORD_SIZE - 1) word[length++] = c;
        usd_text_step(reader);
    }
    word[length] = 0;
    if (length == 0 && reader_ok(reader))
        reader_fail(reader, c ? "unexpected '%c'" : "the file ends within a prim", c);
}

void usd_text_read_word(Reader *reader, char word[USD_WORD_SIZE])
{
    read_text(reader, word, false);
}

void usd_text_read_type(Reader *reader, char word[USD_WORD_SIZE])
{
    read_text(reader, word, true);
}

void usd_text_read_string(Reader *reader, char text[USD_WORD_SIZE])
{
    char quote = usd_text_peek(reader, false);
    text[0] = 0;
    if (quote != '"' && quote != '\'') {
        if (reader_ok(reader)) reader_fail(reader, "expected a string");
        return;
    }
    const uint8_t *at = reader->data + reader->at;
    int marks = at[1] == quote && at[2] == quote ? 3 : 1, found = 0;
    size_t length = 0;
    for (int i = 0; i < marks; ++i) usd_text_step(reader);
    while (found < marks && usd_text_here(reader)) {
        char c = usd_text_here(reader);
        found = c == quote ? found + 1 : 0;
        if (c == '\\') usd_text_step(reader);
        if (found == 0 && length < USD_WORD_SIZE - 1) text[length++] = c;
        usd_text_step(reader);
    }
    text[length] = 0;
    if (found < marks) reader_fail(reader, "a string is not closed: expected a quotation mark");
}

// Skips a path, <...>, or an asset, @...@ or @@@...@@@, in which \@@@ is no end.
static void skip_quoted(Reader *reader, char c)
{
    const uint8_t *at = reader->data + reader->at;
    int marks = c == '@' && at[1] == '@' && at[2] == '@' ? 3 : 1, found = 0;
    char end = c == '<' ? '>' : c;
    for (int i = 0; i < marks; ++i) usd_text_step(reader);
    while (found < marks && (c = usd_text_here(reader))) {
        found = c == end ? found + 1 : 0;
        usd_text_step(reader);
        for (int i = 0; marks == 3 && c == '\\' && i < 3 && usd_text_here(reader) == end; ++i)
            usd_text_step(reader);
    }
    while (marks == 3 && usd_text_here(reader) == end) usd_text_step(reader); // @@@a@@@@: "a@"
    if (found < marks) reader_fail(reader, "a path is not closed: expected '%c'", end);
}

void usd_text_skip_value(Reader *reader)
{
    char text[USD_WORD_SIZE], c = usd_text_peek(reader, false);
    int depth = 0;
    do {
        c = usd_text_peek(reader, false);
        if (c == '"' || c == '\'') {
            usd_text_read_string(reader, text);
        } else if (c == '<' || c == '@') {
            skip_quoted(reader, c);
        } else if (c && strchr("([{", c)) {
            ++depth, usd_text_step(reader);
        } else if (c && strchr(")]}", c)) {
            --depth, usd_text_step(reader);
        } else if (c && depth > 0) {
            usd_text_step(reader);
        } else {
            usd_text_read_word(reader, text);
        }
    } while (depth > 0 && reader_ok(reader) && usd_text_here(reader));
    if (depth > 0) reader_fail(reader, "a bracket is not closed: expected the closing bracket");
}

// With `single` the text is rounded directly to float32, not by way of double.
static double read_number(Reader *reader, bool single)
{
    char text[USD_WORD_SIZE], *end;
    Reader before = *reader;
    usd_text_read_word(reader, text);
    double value = single ? (double)strtof(text, &end) : strtod(text, &end);
    if (!reader_ok(reader) || (end != text && !*end)) return value;
    *reader = before;
    reader_fail(reader, "expected a number, got '%.40s'", text);
    return 0;
}

float usd_text_read_float(Reader *reader)
{
    return (float)read_number(reader, true);
}

double usd_text_read_double(Reader *reader)
{
    return read_number(reader, false);
}

// --- Arrays.

static bool add_value(Reader *reader, UsdValues *values, float value)
{
    if (values->count == values->room) {
        size_t room = 2 * values->room + 12;
        float *more = reader_realloc(reader, values->value, room, sizeof *more);
        if (!more) return reader_fail_memory(reader) == RESULT_OK;
        values->value = more;
        values->room = room;
    }
    values->value[values->count++] = value;
    return true;
}

void usd_text_read_values(Reader *reader, UsdValues *values)
{
    values->count = 0;
    if (usd_text_peek(reader, false) != '[') { // the value is None
        usd_text_skip_value(reader);
        return;
    }
    usd_text_step(reader);
    values->line = reader->line;
    while (!usd_text_take(reader, ']') && reader_ok(reader)) {
        char c = usd_text_here(reader);
        if (c == '(' || c == ')' || c == ',')
            usd_text_step(reader);
        else
            add_value(reader, values, usd_text_read_float(reader));
    }
}

bool usd_text_next_sample(Reader *reader, double *time)
{
    usd_text_take(reader, ',');
    if (!reader_ok(reader) || usd_text_take(reader, '}')) return false;
    char text[USD_WORD_SIZE] = "", *end;
    usd_text_peek(reader, false);
    for (size_t i = 0; i + 1 < sizeof text; ++i) { // keep the colon: it may be part of a name
        char c = usd_text_here(reader);
        if (!c || strchr(":\n {[", c)) break;
        text[i] = c;
        text[i + 1] = 0;
        usd_text_step(reader);
    }
    *time = strtod(text, &end);
    if (reader_ok(reader) && (end == text || *end || !(*time > -1e15 && *time < 1e15)))
        reader_fail(reader, "expected a time, got '%.40s'", text);
    usd_text_expect(reader, ':');
    return reader_ok(reader);
}

void usd_text_read_numbers(Reader *reader, double *numbers, int most)
{
    int count = 0, depth = 0;
    do {
        char c = usd_text_peek(reader, false);
        if (c == '(') {
            ++depth;
        } else if (c == ')') {
            --depth;
        } else if (c != ',' || depth == 0) {
            if (count == most) reader_fail(reader, "more than %d numbers", most);
            if (reader_ok(reader)) numbers[count++] = usd_text_read_double(reader);
            continue;
        }
        usd_text_step(reader);
    } while (depth > 0 && reader_ok(reader));
}
