// SPDX-License-Identifier: MIT
// A whole file, read or written at once.
#pragma once

#include "base/error.h"

#include <stddef.h>
#include <stdint.h>

// `data` has a zero byte after `size`, so that text can be read as a string.
typedef struct Bytes {
    uint8_t *data;
    size_t size;
} Bytes;

// Reads all of `path` ("-" is not special; pipes and devices are read to their end).
// RESULT_BAD_INPUT with the path and the reason (missing, a folder, unreadable), RESULT_FAILED when
// memory is short. Free with bytes_destroy, which accepts a zeroed struct.
Result bytes_read_file(Bytes *bytes, const char *path, Error *error);
void bytes_destroy(Bytes *bytes);

// The same, but "-" is standard input. RESULT_USAGE if it is a terminal or has been read before.
Result bytes_read_input(Bytes *bytes, const char *path, Error *error);

// Removes a UTF-8 byte order mark from the beginning; some editors write it.
void bytes_drop_mark(Bytes *bytes);

// Writes the bytes through an OutFile: the file appears complete or not at all. RESULT_FAILED with
// path and reason.
Result bytes_write_file(const Bytes *bytes, const char *path, Error *error);
