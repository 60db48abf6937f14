// SPDX-License-Identifier: MIT
// UTF-8 text that may contain any bytes.
#pragma once

#include <stddef.h>
#include <stdint.h>

// The number of bytes of the character at `text` if it is complete and valid UTF-8 (RFC 3629),
// otherwise 0.
size_t utf8_length(const char *text, size_t size);

// The same, but 0 for characters that act on a terminal instead of being visible: control
// characters (C0 and C1, including line ends), direction marks, and the byte order mark.
size_t utf8_visible(const char *text, size_t size);

// A zero-terminated copy in which each byte that is not part of valid UTF-8, and each zero, is
// replaced by U+FFFD. The caller frees it. NULL when memory is short.
char *utf8_clean(const char *text, size_t size);
