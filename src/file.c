// SPDX-License-Identifier: MIT
#include "file.h"

#include <errno.h>
#include <fcntl.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

// Reads until the end from `descriptor` into a buffer that starts with room for `capacity` bytes
// and the zero. Returns 0 or an errno. Growing lets pipes and /proc files, whose size is not known,
// be read too.
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
    // One byte more than the size, so that the end of file is met without growing.
    size_t capacity = S_ISREG(status.st_mode) ? (size_t)status.st_size + 1 : 4096;
    int reason = read_all(bytes, descriptor, capacity);
    close(descriptor);
    if (reason == 0) return RESULT_OK;
    bytes_destroy(bytes);
    return error_set(error, reason == ENOMEM ? RESULT_FAILED : RESULT_BAD_INPUT, "%s: %s", path,
                     strerror(reason));
}

void bytes_destroy(Bytes *bytes)
{
    free(bytes->data);
    *bytes = (Bytes){0};
}

static Result fail_to_write(const char *path, int reason, Error *error)
{
    return error_set(error, RESULT_FAILED, "%s: cannot write: %s", path, strerror(reason));
}

// The name under which the file appears. A link to a file is followed, so that the rename does not
// replace the link.
static char *resolve_name(const char *path)
{
    struct stat status;
    bool is_link = lstat(path, &status) == 0 && S_ISLNK(status.st_mode);
    char *target = is_link ? realpath(path, NULL) : NULL;
    return target ? target : strdup(path);
}

// Creates a file that did not exist, beside `path`. mkstemp would do but for its fixed permissions
// of 0600.
static int open_temporary(OutFile *file)
{
    const char *slash = strrchr(file->path, '/');
    int folder_length = slash ? (int)(slash - file->path) + 1 : 0;
    for (unsigned attempt = 0; attempt < 10000; attempt++) {
        if (asprintf(&file->temporary, "%.*s.tractrix-%ld-%u.tmp", folder_length, file->path,
                     (long)getpid(), attempt) < 0) {
            file->temporary = NULL;
            errno = ENOMEM;
            return -1;
        }
        int descriptor = open(file->temporary, O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
        if (descriptor >= 0) return descriptor;
        int reason = errno;
        free(file->temporary);
        file->temporary = NULL;
        errno = reason;
        if (reason != EEXIST) return -1;
    }
    return -1;
}

// Devices and pipes (/dev/stdout) cannot be replaced by renaming: they are written as they are.
static int open_descriptor(OutFile *file)
{
    struct stat status;
    if (stat(file->path, &status) != 0) return open_temporary(file);
    if (S_ISDIR(status.st_mode)) {
        errno = EISDIR;
        return -1;
    }
    if (!S_ISREG(status.st_mode)) return open(file->path, O_WRONLY | O_CLOEXEC);
    // A rename would pass over a file that its owner has made read-only.
    return access(file->path, W_OK) == 0 ? open_temporary(file) : -1;
}

Result outfile_open(OutFile *file, const char *path, Error *error)
{
    *file = (OutFile){0};
    file->path = resolve_name(path);
    if (!file->path) return fail_to_write(path, ENOMEM, error);
    int descriptor = open_descriptor(file);
    int reason = errno;
    if (descriptor >= 0) {
        file->stream = fdopen(descriptor, "wb");
        reason = errno;
        if (!file->stream) close(descriptor);
    }
    if (file->stream) return RESULT_OK;
    outfile_discard(file);
    return fail_to_write(path, reason, error);
}

// The stream remembers that a write failed but not why. The file is lost, so one more byte may ask
// again.
static int find_write_error(OutFile *file)
{
    errno = 0;
    if (fflush(file->stream) == 0 && !ferror(file->stream)) return 0;
    if (errno == 0 && write(fileno(file->stream), "", 1) >= 0) errno = EIO;
    return errno;
}

Result outfile_commit(OutFile *file, Error *error)
{
    int reason = find_write_error(file);
    if (reason == 0 && file->temporary && fsync(fileno(file->stream)) != 0) reason = errno;
    if (fclose(file->stream) != 0 && reason == 0) reason = errno;
    file->stream = NULL;
    if (reason == 0 && file->temporary && rename(file->temporary, file->path) != 0) reason = errno;
    Result result = reason ? fail_to_write(file->path, reason, error) : RESULT_OK;
    if (result == RESULT_OK) {
        free(file->temporary);
        file->temporary = NULL;
    }
    outfile_discard(file);
    return result;
}

void outfile_discard(OutFile *file)
{
    if (file->stream) fclose(file->stream);
    if (file->temporary) unlink(file->temporary);
    free(file->temporary);
    free(file->path);
    *file = (OutFile){0};
}

Result bytes_write_file(const Bytes *bytes, const char *path, Error *error)
{
    OutFile file;
    Result result = outfile_open(&file, path, error);
    if (result != RESULT_OK) return result;
    fwrite(bytes->data, 1, bytes->size, file.stream);
    return outfile_commit(&file, error);
}

void file_scratch_name(char path[PATH_MAX], const char *name)
{
    const char *folder = getenv("TMPDIR");
    snprintf(path, PATH_MAX, "%s/%s-XXXXXX", folder && *folder ? folder : "/tmp", name);
}
