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
// `capacity` bytes and a zero. Unless `capacity` is the most that is read, the buffer grows,
// because the size of pipes and /proc files is not known in advance. Returns 0 or an errno.
static int read_all(Bytes *bytes, int descriptor, size_t capacity, bool most)
{
    bytes->data = malloc(capacity + 1);
    if (!bytes->data) return ENOMEM;
    for (;;) {
        if (bytes->size == capacity && most) break;
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

// --- Plain files.

const char BYTES_IS_NOT_PLAIN[] = "is a device or pipe: expected a plain file";

static bool is_stream(const struct stat *status)
{
    return !S_ISREG(status->st_mode) && !S_ISDIR(status->st_mode);
}

int bytes_open_plain(const char *path, struct stat *status)
{
    // Looking first, because opening some devices starts something.
    if (stat(path, status) != 0) return -1;
    bool stream = is_stream(status);
    int descriptor = stream ? -1 : open(path, O_RDONLY | O_CLOEXEC | O_NONBLOCK | O_NOCTTY);
    int reason = EINVAL;
    if (descriptor >= 0 && fstat(descriptor, status) != 0)
        stream = true, reason = errno;
    else if (descriptor >= 0)
        stream = is_stream(status);
    if (descriptor >= 0 && stream) close(descriptor);
    if (stream) errno = reason;
    return stream ? -1 : descriptor;
}

size_t bytes_peek(const char *path, void *first, size_t size)
{
    struct stat status;
    int descriptor = bytes_open_plain(path, &status);
    if (descriptor < 0) return 0;
    if ((uint64_t)status.st_size < size) size = (size_t)status.st_size;
    ssize_t got = size ? pread(descriptor, first, size, 0) : 0;
    int reason = errno;
    close(descriptor);
    errno = reason;
    return got > 0 ? (size_t)got : 0;
}

static Result fail(const char *path, int reason, Error *error)
{
    return error_set(error, reason == ENOMEM ? RESULT_FAILED : RESULT_BAD_INPUT, "%s: %s", path,
                     strerror(reason));
}

Result bytes_read_plain(Bytes *bytes, const char *path, Error *error)
{
    struct stat status;
    *bytes = (Bytes){0};
    int descriptor = bytes_open_plain(path, &status);
    if (descriptor < 0 && errno == EINVAL)
        return error_set(error, RESULT_BAD_INPUT, "%s: %s", path, BYTES_IS_NOT_PLAIN);
    if (descriptor < 0) return fail(path, errno, error);
    claims_note_input(path, &status);
    int reason = read_all(bytes, descriptor, (size_t)status.st_size, true);
    close(descriptor);
    if (reason == 0) return RESULT_OK;
    bytes_destroy(bytes);
    return fail(path, reason, error);
}

// --- Paths of the command line.

static int argument_count;
static char *const *arguments;

void bytes_set_command_line(int argc, char *const *argv)
{
    argument_count = argc;
    arguments = argv;
}

// Whether the path is an argument, or the value of one ("--mesh=PATH").
static bool is_argument(const char *path)
{
    for (int i = 1; i < argument_count; ++i) {
        const char *text = arguments[i], *equals = *text == '-' ? strchr(text, '=') : NULL;
        if (strcmp(text, path) == 0 || (equals && strcmp(equals + 1, path) == 0)) return true;
    }
    return false;
}

static Result read_stream(Bytes *bytes, const char *path, Error *error)
{
    int descriptor = open(path, O_RDONLY | O_CLOEXEC);
    struct stat status;
    if (descriptor < 0 || fstat(descriptor, &status) != 0) {
        int reason = errno;
        if (descriptor >= 0) close(descriptor);
        return fail(path, reason, error);
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
    int reason = read_all(bytes, descriptor, capacity, false);
    close(descriptor);
    if (reason == 0) return RESULT_OK;
    bytes_destroy(bytes);
    return fail(path, reason, error);
}

Result bytes_read_file(Bytes *bytes, const char *path, Error *error)
{
    *bytes = (Bytes){0};
    return is_argument(path) ? read_stream(bytes, path, error)
                             : bytes_read_plain(bytes, path, error);
}

// --- Standard input.

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
    int reason = read_all(bytes, STDIN_FILENO, 65536, false);
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
