// SPDX-License-Identifier: MIT
// Reads values of a JSON document, with errors that name the place in the document; writes
// documents.
#pragma once

#include "base/bytes.h"
#include "base/error.h"

#include <jansson.h>

#include <stdbool.h>
#include <stddef.h>

// A place in a document, for messages such as "scene.json: sections[2].drag: got ...". The root has
// the file's name as `key` and no parent; a member has its key; an element has `key` NULL and its
// index. Places are on the stack of the functions that descend.
typedef struct JsonPlace {
    const struct JsonPlace *parent;
    const char *key;
    size_t index;
} JsonPlace;

// Sets `error` to the place and the message (printf style); returns RESULT_BAD_INPUT.
Result json_fail(const JsonPlace *place, Error *error, const char *format, ...)
    __attribute__((format(printf, 3, 4)));

// RESULT_BAD_INPUT with the place, "got" and the value (cut to about 60 characters), and
// `expected`.
Result json_refuse(const JsonPlace *place, const json_t *value, const char *expected, Error *error);

// Reads a number, or an array of `count` numbers, each from `minimum` to `maximum`. `expected`
// describes it in words, without the range.
Result json_read_number(const JsonPlace *place, const json_t *value, double minimum, double maximum,
                        const char *expected, double *number, Error *error);
Result json_read_vector(const JsonPlace *place, const json_t *value, size_t count, double minimum,
                        double maximum, const char *expected, float *numbers, Error *error);

// Reads a string that is one of `words` (terminated by NULL), as its index.
Result json_read_choice(const JsonPlace *place, const json_t *value, const char *const *words,
                        int *index, Error *error);

// Checks that `value` is an object with no other keys than `names` (terminated by NULL). The
// message about an unknown key suggests the nearest name.
Result json_check_object(const JsonPlace *place, const json_t *value, const char *const *names,
                         Error *error);

// For programs, not for the library, whose host may use jansson, too: notes from now on when memory
// is short for a JSON value. Call it before any value is made.
void json_memory_watch(void);
// Notes that memory was short for a value of this thread.
void json_memory_note(void);
// Whether memory was short for any JSON value that this thread has made so far. Such values are
// incomplete, because adding to NULL or adding NULL does nothing. Check this before writing a
// document.
bool json_memory_short(void);
// Clears json_memory_short, when the thread has no such values any more.
void json_memory_forget(void);

// Reads an array or an object (RFC 8259) from text that has a zero after `size` bytes; the caller
// owns the reference. NULL with *why (unless that is NULL) if the text is not JSON, has a string
// with a zero, a number that overflows, or values that need more than 64 times its size and 64 MiB;
// or if memory was short, which json_memory_short tells. `flags`: JSON_REJECT_DUPLICATES or 0.
json_t *json_read(const char *text, size_t size, size_t flags, json_error_t *why);

// The value as text, which the caller frees with free(). NULL for no value, or if memory was short
// for the text or any value.
char *json_text(const json_t *value, size_t flags);

// Reads a whole text or file, called `path` in messages; the caller owns *value. RESULT_BAD_INPUT
// with line and column if it is not JSON, RESULT_FAILED if memory is short. `flags` are jansson's.
Result json_parse(json_t **value, const char *path, const Bytes *bytes, size_t flags, Error *error);
Result json_load(json_t **value, const char *path, Error *error);

// Writes `value` as an indented file, which appears complete or not at all; floats are as short as
// float32 allows. Takes no reference. RESULT_FAILED with path and reason, also if memory was short
// when the value was made.
Result json_write_file(const json_t *value, const char *path, Error *error);
