// SPDX-License-Identifier: MIT
// Text that may be any bytes.
#pragma once

#include <stddef.h>

// How many bytes the character at `text` has if it is whole and legal UTF-8 (RFC 3629), else 0.
size_t utf8_length(const char *text, size_t size);

// A copy that ends with a zero, where each byte that is no part of legal UTF-8, and each zero,
// is U+FFFD. Free it. NULL when memory is short.
char *utf8_clean(const char *text, size_t size);
