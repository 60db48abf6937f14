// SPDX-License-Identifier: MIT
// A whole file, read or written at once.
#pragma once

#include "base/error.h"

#include <stddef.h>
#include <stdint.h>
#include <sys/stat.h>

// `data` has a zero byte after `size`, so that text can be read as a string.
typedef struct Bytes {
    uint8_t *data;
    size_t size;
} Bytes;

// Opens a plain file for reading: never a pipe or a device, whose opening or reading might wait for
// ever. The file is checked after it was opened, too. Returns a descriptor and sets *status, or
// returns -1 and sets errno, which is EINVAL for a pipe or device.
int bytes_open_plain(const char *path, struct stat *status);
extern const char BYTES_IS_NOT_PLAIN[]; // the reason for EINVAL

// Reads the first bytes of a plain file, at most `size`; returns their number. 0 if it cannot be
// opened, with errno.
size_t bytes_peek(const char *path, void *first, size_t size);

// Reads all of `path` ("-" is not special), which must be a plain file; it is read up to the size
// that it had when it was opened. RESULT_BAD_INPUT with the path and the reason (missing, a folder,
// unreadable), RESULT_FAILED when memory is short. Free with bytes_destroy, which accepts a zeroed
// struct.
Result bytes_read_plain(Bytes *bytes, const char *path, Error *error);
void bytes_destroy(Bytes *bytes);

// The same, but a path that the user has written on the command line may also lead to a pipe, to a
// terminal or into /proc, and is then read to its end.
Result bytes_read_file(Bytes *bytes, const char *path, Error *error);

// For programs: the arguments of main, which must stay as they are.
void bytes_set_command_line(int argc, char *const *argv);

// The same, but "-" is standard input. RESULT_USAGE if it is a terminal or has been read before.
Result bytes_read_input(Bytes *bytes, const char *path, Error *error);

// Removes a UTF-8 byte order mark from the beginning; some editors write it.
void bytes_drop_mark(Bytes *bytes);

// Writes the bytes through an OutFile: the file appears complete or not at all. RESULT_FAILED with
// path and reason.
Result bytes_write_file(const Bytes *bytes, const char *path, Error *error);
