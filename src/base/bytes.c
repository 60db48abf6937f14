// SPDX-License-Identifier: MIT
#include "base/bytes.h"

#include "base/claims.h"
#include "base/outfile.h"

#include <errno.h>
#include <fcntl.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

// Reads from `descriptor` until the end of the file, into a buffer that first has room for
// `capacity` bytes and a zero. The buffer grows, because the size of pipes and /proc files is not
// known in advance. Returns 0 or an errno.
static int read_all(Bytes *bytes, int descriptor, size_t capacity)
{
    bytes->data = malloc(capacity + 1);
    if (!bytes->data) return ENOMEM;
    for (;;) {
        if (bytes->size == capacity) {
            if (capacity > SIZE_MAX / 2 - 4096) return ENOMEM;
            size_t larger = capacity + capacity / 2 + 4096;
            uint8_t *data = realloc(bytes->data, larger + 1);
            if (!data) return ENOMEM;
            bytes->data = data;
            capacity = larger;
        }
        ssize_t got = read(descriptor, bytes->data + bytes->size, capacity - bytes->size);
        if (got < 0 && errno == EINTR) continue;
        if (got < 0) return errno;
        if (got == 0) break;
        bytes->size += (size_t)got;
    }
    bytes->data[bytes->size] = 0;
    return 0;
}

Result bytes_read_file(Bytes *bytes, const char *path, Error *error)
{
    *bytes = (Bytes){0};
    int descriptor = open(path, O_RDONLY | O_CLOEXEC);
    struct stat status;
    if (descriptor < 0 || fstat(descriptor, &status) != 0) {
        int reason = errno;
        if (descriptor >= 0) close(descriptor);
        return error_set(error, RESULT_BAD_INPUT, "%s: %s", path, strerror(reason));
    }
    if ((S_ISCHR(status.st_mode) && !isatty(descriptor)) || S_ISBLK(status.st_mode)) {
        close(descriptor);
        return error_set(error, RESULT_BAD_INPUT,
                         "%s: is a device, which may never end: expected a file or a pipe", path);
    }
    claims_note_input(path, &status);
    // One byte more than the size, so that read() reports the end of the file before the buffer
    // must grow.
    size_t capacity = S_ISREG(status.st_mode) ? (size_t)status.st_size + 1 : 4096;
    int reason = read_all(bytes, descriptor, capacity);
    close(descriptor);
    if (reason == 0) return RESULT_OK;
    bytes_destroy(bytes);
    return error_set(error, reason == ENOMEM ? RESULT_FAILED : RESULT_BAD_INPUT, "%s: %s", path,
                     strerror(reason));
}

Result bytes_read_input(Bytes *bytes, const char *path, Error *error)
{
    static bool read_before;
    *bytes = (Bytes){0};
    if (strcmp(path, "-") != 0) return bytes_read_file(bytes, path, error);
    if (read_before)
        return error_set(error, RESULT_USAGE, "-: standard input can be read only once");
    if (isatty(STDIN_FILENO))
        return error_set(error, RESULT_USAGE,
                         "-: standard input is a terminal: expected a pipe or a file");
    read_before = true;
    int reason = read_all(bytes, STDIN_FILENO, 65536);
    if (reason == 0) return RESULT_OK;
    bytes_destroy(bytes);
    return error_set(error, reason == ENOMEM ? RESULT_FAILED : RESULT_BAD_INPUT,
                     "-: standard input: %s", strerror(reason));
}

void bytes_destroy(Bytes *bytes)
{
    free(bytes->data);
    *bytes = (Bytes){0};
}

void bytes_drop_mark(Bytes *bytes)
{
    static const char MARK[] = "\xef\xbb\xbf";
    size_t length = sizeof MARK - 1;
    if (bytes->size < length || memcmp(bytes->data, MARK, length) != 0) return;
    bytes->size -= length;
    memmove(bytes->data, bytes->data + length, bytes->size + 1); // including the zero
}

Result bytes_write_file(const Bytes *bytes, const char *path, Error *error)
{
    OutFile file;
    TRY(outfile_open(&file, path, error));
    fwrite(bytes->data, 1, bytes->size, file.stream);
    return outfile_commit(&file, error);
}
