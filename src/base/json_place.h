// SPDX-License-Identifier: MIT
// Values out of a JSON document, with errors that say where in the document they stand.
#pragma once

#include "base/error.h"

#include <jansson.h>
#include <stddef.h>

// A place in a document, for messages such as "scene.json: sections[2].drag: got ...". The root has
// the file's name as `key` and no parent; a member has its key; an element has `key` NULL and its
// index. Places live on the stack of whoever descends.
typedef struct Place {
    const struct Place *parent;
    const char *key;
    size_t index;
} Place;

// Sets `error` to the place and the printf-style rest; returns RESULT_BAD_INPUT.
Result place_fail(const Place *place, Error *error, const char *format, ...)
    __attribute__((format(printf, 3, 4)));

// RESULT_BAD_INPUT with the place, "got" and the value, cut to some 60 characters, and what was
// `expected`.
Result place_refuse(const Place *place, const json_t *value, const char *expected, Error *error);

// Reads a number, or an array of `count` numbers, each from `minimum` to `maximum`. `expected` says
// what it should be, in words and without the range.
Result place_read_number(const Place *place, const json_t *value, double minimum, double maximum,
                         const char *expected, double *number, Error *error);
Result place_read_vector(const Place *place, const json_t *value, size_t count, double minimum,
                         double maximum, const char *expected, float *numbers, Error *error);

// Reads a string that is one of `words` (ended by NULL) as its index.
Result place_read_choice(const Place *place, const json_t *value, const char *const *words,
                         int *index, Error *error);

// Whether `value` is an object with no other keys than `names` (ended by NULL). An unknown key's
// message names the nearest of them.
Result place_check_object(const Place *place, const json_t *value, const char *const *names,
                          Error *error);
