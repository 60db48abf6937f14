// SPDX-License-Identifier: MIT
// A whole file, read or written at once.
#pragma once

#include "base/error.h"

#include <stddef.h>
#include <stdint.h>

// `data` has one more byte, zero, behind `size`, so that text can be read as a string.
typedef struct Bytes {
    uint8_t *data;
    size_t size;
} Bytes;

// Reads all of `path` ("-" is not special; pipes and devices are read until they end). Fails with
// RESULT_BAD_INPUT naming the path and the reason (missing, a folder, unreadable), or RESULT_FAILED
// when memory is short. Free with bytes_destroy, which takes a zeroed struct too.
Result bytes_read_file(Bytes *bytes, const char *path, Error *error);
void bytes_destroy(Bytes *bytes);

// The same, but "-" is standard input. RESULT_USAGE if it is a terminal or has been read before.
Result bytes_read_input(Bytes *bytes, const char *path, Error *error);

// Removes a byte-order mark of UTF-8 from the beginning, as some editors put it before text.
void bytes_drop_mark(Bytes *bytes);

// Writes the bytes as a whole file through an OutFile: complete or not at all, RESULT_FAILED
// with path and reason.
Result bytes_write_file(const Bytes *bytes, const char *path, Error *error);
