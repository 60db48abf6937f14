// SPDX-License-Identifier: MIT
// The name that a user may have meant.
#pragma once

#include <stddef.h>

// The one of `names` that is nearest to `word`, the first of equals; NULL if none is near. Near: at
// most one edit for each three letters of the word, and three in all (insertion, deletion,
// replacement, swap of neighbours; case does not count, '-' is '_'), or a name that begins with the
// word's three or more letters. Of longer words only the first 63 characters are compared.
const char *suggest_nearest(const char *word, const char *const *names, size_t count);

// The end of a message about a word that is none of `names`: "did you mean 'drag'?" or, if none is
// near, "expected drag, gust or fps". Returns `text`, which is empty if that does not fit.
const char *suggest_words(char *text, size_t size, const char *word, const char *const *names,
                          size_t count);
