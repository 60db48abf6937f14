// SPDX-License-Identifier: MIT
// The text of `.usda` files: words, strings, numbers, arrays. The reader's data ends with a zero;
// what is wrong fails the reader, which then is at its end.
#pragma once

#include "base/reader.h"

#include <stdbool.h>
#include <stddef.h>

enum { USD_WORD_SIZE = 128 };

// The character that comes, 0 at the end; and past it.
char usd_text_here(const Reader *reader);
void usd_text_step(Reader *reader);

// The next character that is neither blank nor comment, 0 at the end; with `line` not beyond it.
char usd_text_peek(Reader *reader, bool line);

// Past `wanted` if it is what comes next; expect: fails if it is not.
bool usd_text_take(Reader *reader, char wanted);
void usd_text_expect(Reader *reader, char wanted);

// Whether names and numbers may have it.
bool usd_text_is_letter(char c);

// A name or a number, or a type, which may have brackets; cut if it is too long to be one that is
// known.
void usd_text_read_word(Reader *reader, char word[USD_WORD_SIZE]);
void usd_text_read_type(Reader *reader, char word[USD_WORD_SIZE]);

// A string in its quotes, 'x', "x" or with three of either; the first characters to `text`.
void usd_text_read_string(Reader *reader, char text[USD_WORD_SIZE]);

// Whatever value comes: brackets with all that is in them, a string, a path, an asset, a word.
void usd_text_skip_value(Reader *reader);

// One number; beyond what float32 holds it is infinite.
float usd_text_read_float(Reader *reader);

// All numbers between brackets, however they are grouped. `value` is the caller's to free.
typedef struct UsdValues {
    float *value;
    size_t count, room;
    uint32_t line; // 0: there are none
    double time;   // of a sample
} UsdValues;

// An array, or the word None.
void usd_text_read_values(Reader *reader, UsdValues *values);

// Within { time: value, ... }: steps to the next value and gives its time; false, past the brace,
// if there is none.
bool usd_text_next_sample(Reader *reader, double *time);

// One number, or a tuple of at most `most`, however grouped; those that are not there stay.
void usd_text_read_numbers(Reader *reader, double *numbers, int most);
