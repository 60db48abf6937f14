// SPDX-License-Identifier: MIT
// json_read: makes jansson's values from text. jansson's own parser drops characters and may then
// fail an assertion when memory is short, and it limits neither memory nor the host's allocator.
#include "base/json.h"
#include "base/utf8.h"

#include <errno.h>
#include <stdlib.h>
#include <string.h>

// Arrays and objects in each other, as in jansson.
enum { MOST_DEPTH = 2048 };
// What jansson and malloc use for a value, in bytes, rounded up: an array with 8 places, an object
// with 8 buckets, a member without its key, other values without their text.
enum { ARRAY_BYTES = 160, OBJECT_BYTES = 288, MEMBER_BYTES = 112, ATOM_BYTES = 64 };

typedef struct Parser {
    const char *at, *end;
    const char *line_start;
    int line, depth;
    bool unique_keys;
    bool failed;     // `why` is set
    uint64_t memory; // bytes that values may still use
    json_error_t *why;
} Parser;

static json_t *fail(Parser *parser, const char *text)
{
    if (parser->failed) return NULL;
    parser->failed = true;
    json_error_t *why = parser->why;
    *why = (json_error_t){.line = parser->line,
                          .column = (int)(parser->at - parser->line_start) + 1,
                          .position = (int)(parser->at - parser->line_start)};
    snprintf(why->text, sizeof why->text, "%s", text);
    return NULL;
}

static json_t *fail_expected(Parser *parser, const char *what)
{
    char text[JSON_ERROR_TEXT_LENGTH];
    size_t left = (size_t)(parser->end - parser->at), length = 0;
    while (length < left && length < 20 && !strchr(" \t\r\n,]}", parser->at[length])) ++length;
    if (!left)
        snprintf(text, sizeof text, "expected %s, got the end of the text", what);
    else
        snprintf(text, sizeof text, "expected %s, got '%.*s'", what, length ? (int)length : 1,
                 parser->at);
    return fail(parser, text);
}

// Whether the values may use this many more bytes; otherwise fails.
static bool take_memory(Parser *parser, uint64_t bytes)
{
    if (bytes <= parser->memory) {
        parser->memory -= bytes;
        return true;
    }
    fail(parser, "needs more memory than 64 times its size and 64 MiB");
    return false;
}

// Marks that memory was short if `value` is NULL.
static json_t *made(Parser *parser, json_t *value)
{
    if (value) return value;
    json_memory_note();
    return fail(parser, "out of memory");
}

static void skip_blanks(Parser *parser)
{
    for (; parser->at < parser->end && strchr(" \t\r\n", *parser->at) && *parser->at; ++parser->at)
        if (*parser->at == '\n') {
            ++parser->line;
            parser->line_start = parser->at + 1;
        }
}

// Steps over the character `c` and blanks before it.
static bool take(Parser *parser, char c)
{
    skip_blanks(parser);
    if (parser->at == parser->end || *parser->at != c) return false;
    ++parser->at;
    return true;
}

// --- Strings.

// The four hexadecimal digits at `at`, -1 if there are others.
static long read_hex(const Parser *parser, const char *at)
{
    long value = 0;
    for (int i = 0; i < 4; ++i) {
        static const char digits[] = "0123456789abcdefABCDEF";
        const char *digit = at + i < parser->end && at[i] ? strchr(digits, at[i]) : NULL;
        if (!digit) return -1;
        long place = digit - digits;
        value = value * 16 + (place < 16 ? place : place - 6);
    }
    return value;
}

static char *put_character(char *out, long code)
{
    if (code < 0x80) {
        *out++ = (char)code;
    } else if (code < 0x800) {
        *out++ = (char)(0xc0 | code >> 6);
        *out++ = (char)(0x80 | (code & 0x3f));
    } else if (code < 0x10000) {
        *out++ = (char)(0xe0 | code >> 12);
        *out++ = (char)(0x80 | (code >> 6 & 0x3f));
        *out++ = (char)(0x80 | (code & 0x3f));
    } else {
        *out++ = (char)(0xf0 | code >> 18);
        *out++ = (char)(0x80 | (code >> 12 & 0x3f));
        *out++ = (char)(0x80 | (code >> 6 & 0x3f));
        *out++ = (char)(0x80 | (code & 0x3f));
    }
    return out;
}

// Reads what follows a backslash; NULL after an error.
static char *read_escape(Parser *parser, char *out)
{
    static const char letters[] = "\"\\/bfnrt", meant[] = "\"\\/\b\f\n\r\t";
    const char *found =
        parser->at < parser->end && *parser->at ? strchr(letters, *parser->at) : NULL;
    if (found) {
        ++parser->at;
        *out++ = meant[found - letters];
        return out;
    }
    long code =
        parser->at < parser->end && *parser->at == 'u' ? read_hex(parser, parser->at + 1) : -1;
    size_t length = 5;
    if (code >= 0xd800 && code < 0xdc00 && parser->end - parser->at >= 11 &&
        parser->at[5] == '\\' && parser->at[6] == 'u') {
        long low = read_hex(parser, parser->at + 7);
        code =
            low >= 0xdc00 && low < 0xe000 ? 0x10000 + ((code - 0xd800) << 10) + (low - 0xdc00) : -1;
        length = 11;
    }
    if (code <= 0 || (code >= 0xd800 && code < 0xe000)) {
        fail(parser, "expected an escape sequence of JSON after \\");
        return NULL;
    }
    parser->at += length;
    return put_character(out, code);
}

// The string whose quote has just been read, to be freed by the caller; NULL after an error.
static char *read_string(Parser *parser, size_t *length)
{
    const char *last = parser->at;
    while (last < parser->end && *last != '"' && *last != '\n') last += 1 + (*last == '\\');
    // The text is never longer than what stands for it.
    size_t room = (size_t)((last < parser->end ? last : parser->end) - parser->at) + 1;
    if (!take_memory(parser, 2 * room)) return NULL;
    char *text = malloc(room), *out = text;
    if (!text) {
        made(parser, NULL);
        return NULL;
    }
    while (out && parser->at < parser->end && *parser->at != '"') {
        size_t size = utf8_length(parser->at, (size_t)(parser->end - parser->at));
        if ((unsigned char)*parser->at < 0x20) {
            out = NULL;
            fail(parser, "a control character in a string: expected an escape such as \\n");
        } else if (*parser->at == '\\') {
            ++parser->at;
            out = read_escape(parser, out);
        } else if (size) {
            memcpy(out, parser->at, size);
            parser->at += size;
            out += size;
        } else {
            out = NULL;
            fail(parser, "expected UTF-8");
        }
    }
    if (out && parser->at == parser->end) {
        out = NULL;
        fail_expected(parser, "a quote");
    }
    if (!out) {
        free(text);
        return NULL;
    }
    ++parser->at;
    *out = 0;
    *length = (size_t)(out - text);
    return text;
}

// --- Numbers.

static const char *skip_digits(const char *at)
{
    while (*at >= '0' && *at <= '9') ++at;
    return at;
}

// The number between two places. (strtoll would do, but with strict checks of strings the
// sanitizers look for the file's end in each call.) False if it is too large.
static bool parse_integer(const char *at, const char *end, json_int_t *value)
{
    bool negative = *at == '-';
    *value = 0;
    for (at += negative; at < end; ++at)
        if (__builtin_mul_overflow(*value, 10, value) ||
            __builtin_add_overflow(*value, negative ? '0' - *at : *at - '0', value))
            return false;
    return true;
}

static json_t *read_number(Parser *parser)
{
    const char *at = parser->at + (*parser->at == '-'), *digits = at;
    bool whole = true;
    at = *at == '0' ? at + 1 : skip_digits(at);
    bool good = at > digits;
    if (good && *at == '.') {
        digits = at + 1;
        at = skip_digits(digits);
        good = at > digits;
        whole = false;
    }
    if (good && (*at == 'e' || *at == 'E')) {
        digits = at + 1 + (at[1] == '-' || at[1] == '+');
        at = skip_digits(digits);
        good = at > digits;
        whole = false;
    }
    if (!good || at > parser->end) return fail_expected(parser, "a value");
    errno = 0;
    json_int_t integer = 0;
    double real = whole ? 0 : strtod(parser->at, NULL);
    if (whole ? !parse_integer(parser->at, at, &integer) : errno && (real > 1 || real < -1))
        return fail(parser, "the number is too large");
    if (!take_memory(parser, ATOM_BYTES)) return NULL;
    parser->at = at;
    return made(parser, whole ? json_integer(integer) : json_real(real));
}

// --- Values.

static json_t *read_value(Parser *parser);

static json_t *read_array(Parser *parser)
{
    if (!take_memory(parser, ARRAY_BYTES)) return NULL;
    json_t *array = made(parser, json_array());
    if (!array || take(parser, ']')) return array;
    do {
        json_t *value = read_value(parser);
        // An array grows by doubling.
        if (value && take_memory(parser, 3 * sizeof value) && json_array_append_new(array, value))
            made(parser, NULL);
    } while (!parser->failed && take(parser, ','));
    if (!parser->failed && !take(parser, ']')) fail_expected(parser, "',' or ']'");
    if (!parser->failed) return array;
    json_decref(array);
    return NULL;
}

static void read_member(Parser *parser, json_t *object)
{
    size_t length = 0;
    char *key = take(parser, '"') ? read_string(parser, &length) : NULL;
    if (!key) {
        fail_expected(parser, "a key in quotes");
        return;
    }
    if (parser->unique_keys && json_object_get(object, key)) {
        char text[JSON_ERROR_TEXT_LENGTH];
        snprintf(text, sizeof text, "the key \"%.60s\" is there twice", key);
        fail(parser, text);
    }
    if (!parser->failed && !take(parser, ':')) fail_expected(parser, "':'");
    json_t *value = parser->failed ? NULL : read_value(parser);
    if (value && (!take_memory(parser, MEMBER_BYTES) ||
                  json_object_set_new_nocheck(object, key, value) != 0))
        made(parser, NULL);
    free(key);
}

static json_t *read_object(Parser *parser)
{
    if (!take_memory(parser, OBJECT_BYTES)) return NULL;
    json_t *object = made(parser, json_object());
    if (!object || take(parser, '}')) return object;
    do read_member(parser, object);
    while (!parser->failed && take(parser, ','));
    if (!parser->failed && !take(parser, '}')) fail_expected(parser, "',' or '}'");
    if (!parser->failed) return object;
    json_decref(object);
    return NULL;
}

static json_t *read_word(Parser *parser)
{
    static const char *const words[] = {"null", "false", "true"};
    for (int i = 0; i < 3; ++i) {
        size_t length = strlen(words[i]);
        if ((size_t)(parser->end - parser->at) < length ||
            memcmp(parser->at, words[i], length) != 0)
            continue;
        parser->at += length;
        return i == 0 ? json_null() : json_boolean(i == 2);
    }
    return fail_expected(parser, "a value");
}

static json_t *read_value(Parser *parser)
{
    skip_blanks(parser);
    if (parser->at == parser->end) return fail_expected(parser, "a value");
    char c = *parser->at;
    if (c == '[' || c == '{') {
        if (parser->depth == MOST_DEPTH) return fail(parser, "too many brackets in each other");
        ++parser->depth;
        ++parser->at;
        json_t *value = c == '[' ? read_array(parser) : read_object(parser);
        --parser->depth;
        return value;
    }
    if (c != '"')
        return c == '-' || (c >= '0' && c <= '9') ? read_number(parser) : read_word(parser);
    size_t length = 0;
    ++parser->at;
    char *text = read_string(parser, &length);
    json_t *value = text && take_memory(parser, ATOM_BYTES)
                        ? made(parser, json_stringn_nocheck(text, length))
                        : NULL;
    free(text);
    return value;
}

json_t *json_read(const char *text, size_t size, size_t flags, json_error_t *why)
{
    json_error_t unused = {0};
    Parser parser = {.at = text,
                     .end = text + size,
                     .line_start = text,
                     .line = 1,
                     .unique_keys = flags & JSON_REJECT_DUPLICATES,
                     .memory = ((uint64_t)64 << 20) + (uint64_t)64 * size,
                     .why = why ? why : &unused};
    skip_blanks(&parser);
    if (parser.at == parser.end || !strchr("[{", *parser.at))
        return fail_expected(&parser, "'[' or '{'");
    json_t *value = read_value(&parser);
    skip_blanks(&parser);
    if (!parser.failed && parser.at < parser.end) fail_expected(&parser, "the end of the text");
    if (!parser.failed) return value;
    json_decref(value);
    return NULL;
}
