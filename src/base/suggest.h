// SPDX-License-Identifier: MIT
// The name that a user may have meant.
#pragma once

#include <stddef.h>

// The one of `names` with the fewest edits (insertion, deletion, replacement or swap of neighbours;
// case does not count, and '-' is '_') from `word`, the first of equals; NULL only if `count` is 0.
// Of longer words only the first 63 characters are compared.
const char *suggest_nearest(const char *word, const char *const *names, size_t count);
