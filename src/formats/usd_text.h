// SPDX-License-Identifier: MIT
// The text of `.usda` files: words, strings, numbers, arrays. The reader's data must end with a
// zero. Errors fail the reader, which is then at its end.
#pragma once

#include "base/reader.h"

#include <stdbool.h>
#include <stddef.h>

enum { USD_WORD_SIZE = 128 };

// usd_text_here: the current character, 0 at the end. usd_text_step: moves past it.
char usd_text_here(const Reader *reader);
void usd_text_step(Reader *reader);

// The next character that is neither blank nor comment, 0 at the end; with `line` only on this
// line.
char usd_text_peek(Reader *reader, bool line);

// Moves past `wanted` if it is next; usd_text_expect fails if it is not.
bool usd_text_take(Reader *reader, char wanted);
void usd_text_expect(Reader *reader, char wanted);

// Whether the character may be part of names and numbers.
bool usd_text_is_letter(char c);

// Reads a name, a number, or a type, which may have brackets. Cut if it is too long for a known
// word.
void usd_text_read_word(Reader *reader, char word[USD_WORD_SIZE]);
void usd_text_read_type(Reader *reader, char word[USD_WORD_SIZE]);

// Reads a quoted string, 'x', "x" or with three quotes; stores its first characters in `text`.
void usd_text_read_string(Reader *reader, char text[USD_WORD_SIZE]);

// Skips any value: brackets with their content, a string, a path, an asset, a word.
void usd_text_skip_value(Reader *reader);

// A number; infinite if it is beyond float32, or float64.
float usd_text_read_float(Reader *reader);
double usd_text_read_double(Reader *reader);

// All numbers between brackets, regardless of nested brackets. The caller frees `value`.
typedef struct UsdValues {
    float *value;
    size_t count, room;
    uint32_t line; // 0 if there are none
    double time;   // of a sample
} UsdValues;

// Reads an array, or the word None.
void usd_text_read_values(Reader *reader, UsdValues *values);

// Within { time: value, ... }: moves to the next value and returns its time; false, past the brace,
// if there is none.
bool usd_text_next_sample(Reader *reader, double *time);

// Reads a number, or at most `most` numbers of a tuple; missing ones stay unchanged.
void usd_text_read_numbers(Reader *reader, double *numbers, int most);
