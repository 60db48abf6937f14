// SPDX-License-Identifier: MIT
// Reads values of a JSON document with errors that name the place in the document; writes
// documents.
#pragma once

#include "base/bytes.h"
#include "base/error.h"

#include <jansson.h>

#include <stdbool.h>
#include <stddef.h>

// A place in a document, for messages such as "scene.json: sections[2].drag: got ...". The root has
// the file's name as `key` and no parent; a member has its key; an element has `key` NULL and its
// index. Places live on the stack of whoever descends.
typedef struct JsonPlace {
    const struct JsonPlace *parent;
    const char *key;
    size_t index;
} JsonPlace;

// Sets `error` to the place and the printf-style rest; returns RESULT_BAD_INPUT.
Result json_fail(const JsonPlace *place, Error *error, const char *format, ...)
    __attribute__((format(printf, 3, 4)));

// RESULT_BAD_INPUT with the place, "got" and the value, cut to some 60 characters, and what was
// `expected`.
Result json_refuse(const JsonPlace *place, const json_t *value, const char *expected, Error *error);

// Reads a number, or an array of `count` numbers, each from `minimum` to `maximum`. `expected` says
// what it should be, in words and without the range.
Result json_read_number(const JsonPlace *place, const json_t *value, double minimum, double maximum,
                        const char *expected, double *number, Error *error);
Result json_read_vector(const JsonPlace *place, const json_t *value, size_t count, double minimum,
                        double maximum, const char *expected, float *numbers, Error *error);

// Reads a string that is one of `words` (ended by NULL) as its index.
Result json_read_choice(const JsonPlace *place, const json_t *value, const char *const *words,
                        int *index, Error *error);

// Whether `value` is an object with no other keys than `names` (ended by NULL). An unknown key's
// message names the nearest of them.
Result json_check_object(const JsonPlace *place, const json_t *value, const char *const *names,
                         Error *error);

// Whether memory was short for any JSON value that this thread has made so far: values are then
// incomplete, since what is put into NULL, or is NULL, is dropped without a word. Whoever writes a
// document asks before.
bool json_memory_short(void);
// Forgets that: for a thread that has none of those values any more.
void json_memory_forget(void);

// Reads a value; the caller owns the reference. NULL with *why (NULL: nowhere) if the text is no
// JSON, or if memory was short: jansson then loses a number's last digits without a word, so that
// no value counts. json_memory_short tells the two apart.
json_t *json_read(const void *text, size_t size, size_t flags, json_error_t *why);

// The value as text, owned by the caller, for free(); NULL for no value, and if memory was short
// when the text or any value was made.
char *json_text(const json_t *value, size_t flags);

// Reads a whole text or file, named `path` in messages; the caller owns *value. RESULT_BAD_INPUT
// with line and column if it is no JSON, RESULT_FAILED if memory is short. `flags` are jansson's.
Result json_parse(json_t **value, const char *path, const Bytes *bytes, size_t flags, Error *error);
Result json_load(json_t **value, const char *path, Error *error);

// Writes `value` as an indented file that appears complete or not at all; floats are as short as
// float32 allows. Takes no reference. RESULT_FAILED with path and reason, also if memory was short
// when the value was made.
Result json_write_file(const json_t *value, const char *path, Error *error);
