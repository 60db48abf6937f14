// SPDX-License-Identifier: MIT
// Text that may be any bytes.
#pragma once

#include <stddef.h>
#include <stdint.h>

// How many bytes the character at `text` has if it is whole and legal UTF-8 (RFC 3629), else 0.
size_t utf8_length(const char *text, size_t size);

// The same, but 0 for what acts on a terminal instead of standing there: control characters (C0 and
// C1, line ends among them), marks of direction, and the byte-order mark.
size_t utf8_visible(const char *text, size_t size);

// A copy that ends with a zero, where each byte that is no part of legal UTF-8, and each zero,
// is U+FFFD. Free it. NULL when memory is short.
char *utf8_clean(const char *text, size_t size);
