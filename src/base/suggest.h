// SPDX-License-Identifier: MIT
// Suggests the name that a user may have meant.
#pragma once

#include <stddef.h>

// The first of the nearest `names` to `word`; NULL if none is near. Near means at most one edit per
// three letters of the word, and three in all (insertion, deletion, replacement, swap of
// neighbours; ignoring case, '-' equals '_'), that the name begins with the word, or that one of
// them ends in the other after a '-'; the shorter one must have at least three letters. Only the
// first 63 characters of a word are compared.
const char *suggest_nearest(const char *word, const char *const *names, size_t count);

// The end of a message about a word that is not among `names`: "did you mean 'drag'?" or, if none
// is near, "expected drag, gust or fps". Returns `text`, which is empty if that does not fit.
const char *suggest_words(char *text, size_t size, const char *word, const char *const *names,
                          size_t count);
