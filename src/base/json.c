// SPDX-License-Identifier: MIT
#include "base/json.h"
#include "base/outfile.h"
#include "base/quote.h"
#include "base/suggest.h"

#include <math.h>
#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { EXCERPT_SIZE = 64 };

static _Thread_local bool memory_short;

void json_memory_note(void)
{
    memory_short = true;
}

bool json_memory_short(void)
{
    return memory_short;
}

void json_memory_forget(void)
{
    memory_short = false;
}

// Writes the path of the place, from the root on. Returns its length, at most `size` - 1.
static size_t name_place(const JsonPlace *place, char *text, size_t size)
{
    size_t length = place->parent ? name_place(place->parent, text, size) : 0;
    const char *between = !place->parent ? "" : place->parent->parent ? "." : ": ";
    if (place->key) {
        char key[304]; // a path is shortened in its middle, so that the file's name is kept
        quote_line(key, place->parent ? 84 : sizeof key, place->key);
        length += (size_t)snprintf(text + length, size - length, "%s%s", between, key);
    } else
        length += (size_t)snprintf(text + length, size - length, "[%zu]", place->index);
    return length < size ? length : size - 1;
}

Result json_fail(const JsonPlace *place, Error *error, const char *format, ...)
{
    char name[512], rest[400];
    name_place(place, name, sizeof name);
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(rest, sizeof rest, format, arguments);
    va_end(arguments);
    return error_set(error, RESULT_BAD_INPUT, "%s: %s", name, rest);
}

// The first characters of a value's text.
typedef struct Excerpt {
    char text[EXCERPT_SIZE];
    size_t length;
} Excerpt;

// A json_dump_callback_t: stores what fits, and stops the dump when the excerpt is full.
static int append_to_excerpt(const char *bytes, size_t size, void *data)
{
    Excerpt *excerpt = data;
    size_t room = sizeof excerpt->text - 1 - excerpt->length;
    bool fits = size <= room;
    if (!fits) size = room;
    memcpy(excerpt->text + excerpt->length, bytes, size);
    excerpt->length += size;
    return fits ? 0 : -1;
}

// The value as JSON on one line, cut at a character boundary.
static Excerpt excerpt_value(const json_t *value)
{
    Excerpt excerpt = {.length = 0};
    size_t flags = JSON_ENCODE_ANY | JSON_COMPACT | JSON_REAL_PRECISION(9);
    if (json_dump_callback(value, append_to_excerpt, &excerpt, flags) != 0) {
        size_t cut = sizeof excerpt.text - 4;
        while (cut > 0 && (excerpt.text[cut] & 0xc0) == 0x80) cut--;
        memcpy(excerpt.text + cut, "...", 4);
    }
    return excerpt;
}

Result json_refuse(const JsonPlace *place, const json_t *value, const char *expected, Error *error)
{
    return json_fail(place, error, "got %s, expected %s", excerpt_value(value).text, expected);
}

Result json_read_number(const JsonPlace *place, const json_t *value, double minimum, double maximum,
                        const char *expected, double *number, Error *error)
{
    double read = json_number_value(value);
    double inside = fmin(fmax(read, minimum), maximum);
    char words[160];
    int length =
        snprintf(words, sizeof words, "%s from %.10g to %.10g", expected, minimum, maximum);
    if (json_is_number(value) && read == inside) {
        *number = read;
        return RESULT_OK;
    }
    if (json_is_number(value))
        snprintf(words + length, sizeof words - (size_t)length, " (nearest: %.10g)", inside);
    return json_refuse(place, value, words, error);
}

Result json_read_vector(const JsonPlace *place, const json_t *value, size_t count, double minimum,
                        double maximum, const char *expected, float *numbers, Error *error)
{
    if (!json_is_array(value) || json_array_size(value) != count)
        return json_refuse(place, value, expected, error);
    for (size_t i = 0; i < count; i++) {
        JsonPlace element = {.parent = place, .index = i};
        double number;
        TRY(json_read_number(&element, json_array_get(value, i), minimum, maximum, "a number",
                             &number, error));
        numbers[i] = (float)number;
    }
    return RESULT_OK;
}

static size_t count_words(const char *const *words)
{
    size_t count = 0;
    while (words[count]) count++;
    return count;
}

Result json_read_choice(const JsonPlace *place, const json_t *value, const char *const *words,
                        int *index, Error *error)
{
    char expected[160] = "one of";
    size_t length = strlen(expected), count = count_words(words);
    for (size_t i = 0; i < count; i++) {
        if (json_is_string(value) && strcmp(json_string_value(value), words[i]) == 0) {
            *index = (int)i;
            return RESULT_OK;
        }
        if (length < sizeof expected)
            length +=
                (size_t)snprintf(expected + length, sizeof expected - length, " \"%s\"", words[i]);
    }
    const char *nearest =
        json_is_string(value) ? suggest_nearest(json_string_value(value), words, count) : NULL;
    if (nearest && length < sizeof expected)
        snprintf(expected + length, sizeof expected - length, " (nearest: \"%s\")", nearest);
    return json_refuse(place, value, expected, error);
}

Result json_check_object(const JsonPlace *place, const json_t *value, const char *const *names,
                         Error *error)
{
    if (!json_is_object(value)) return json_refuse(place, value, "an object", error);
    size_t count = count_words(names);
    const char *key;
    json_t *member;
    json_object_foreach((json_t *)value, key, member)
    {
        size_t i = 0;
        while (i < count && strcmp(key, names[i]) != 0) i++;
        char words[160];
        if (i == count)
            return json_fail(place, error, "unknown key '%.60s': %s", key,
                             *suggest_words(words, sizeof words, key, names, count)
                                 ? words
                                 : "expected a key of --help schema");
    }
    return RESULT_OK;
}

char *json_text(const json_t *value, size_t flags)
{
    char *dump = value ? json_dumps(value, flags) : NULL;
    char *text = dump && !json_memory_short() ? strdup(dump) : NULL;
    json_malloc_t allocates;
    json_free_t releases;
    json_get_alloc_funcs(&allocates, &releases);
    if (dump) releases(dump);
    return text;
}

Result json_parse(json_t **value, const char *path, const Bytes *bytes, size_t flags, Error *error)
{
    json_error_t why;
    *value = json_read((const char *)bytes->data, bytes->size, flags, &why);
    if (*value) return RESULT_OK;
    if (json_memory_short()) return error_set(error, RESULT_FAILED, "%s: out of memory", path);
    return error_set(error, RESULT_BAD_INPUT, "%s:%d:%d: %s", path, why.line, why.column, why.text);
}

Result json_load(json_t **value, const char *path, Error *error)
{
    Bytes bytes;
    *value = NULL;
    TRY(bytes_read_file(&bytes, path, error));
    Result result = json_parse(value, path, &bytes, 0, error);
    bytes_destroy(&bytes);
    return result;
}

Result json_write_file(const json_t *value, const char *path, Error *error)
{
    char *text = json_text(value, JSON_INDENT(2) | JSON_REAL_PRECISION(9));
    if (!text) return error_set(error, RESULT_FAILED, "%s: no memory for the result", path);
    OutFile file;
    Result result = outfile_open(&file, path, error);
    if (result == RESULT_OK) fprintf(file.stream, "%s\n", text);
    THEN(result, outfile_commit(&file, error));
    free(text);
    return result;
}
