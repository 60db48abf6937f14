// SPDX-License-Identifier: MIT
#include "base/outfile.h"

#include <errno.h>
#include <fcntl.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

bool outfile_is_stdout(const char *path)
{
    return strcmp(path, "-") == 0;
}

Result outfile_refuse_terminal(const char *path, Error *error)
{
    if (!outfile_is_stdout(path) || !isatty(STDOUT_FILENO)) return RESULT_OK;
    return error_set(error, RESULT_USAGE,
                     "standard output is a terminal: expected a pipe or a file for binary data");
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
    if (outfile_is_stdout(path)) return strdup("standard output");
    bool is_link = lstat(path, &status) == 0 && S_ISLNK(status.st_mode);
    char *target = is_link ? realpath(path, NULL) : NULL;
    return target ? target : strdup(path);
}

// Creates a file that did not exist, beside `path`. mkstemp would do but for its fixed permissions
// of 0600.
static int create_temporary(OutFile *file, const char *folder)
{
    for (unsigned attempt = 0; attempt < 10000; attempt++) {
        char name[LEFTOVER_NAME_SIZE];
        leftovers_name(name, attempt);
        if (asprintf(&file->temporary, "%s%s", folder, name) < 0) {
            file->temporary = NULL;
            errno = ENOMEM;
            return -1;
        }
        int descriptor = open(file->temporary, O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
        if (descriptor >= 0) {
            flock(descriptor, LOCK_SH | LOCK_NB); // somebody uses it; see leftovers_sweep
            file->leftover = leftover_add_file(file->temporary);
            return descriptor;
        }
        int reason = errno;
        free(file->temporary);
        file->temporary = NULL;
        errno = reason;
        if (reason != EEXIST) return -1;
    }
    return -1;
}

static int open_temporary(OutFile *file)
{
    const char *slash = strrchr(file->path, '/');
    char *folder = strndup(file->path, slash ? (size_t)(slash - file->path) + 1 : 0);
    if (!folder) return -1;
    leftovers_sweep(*folder ? folder : ".");
    int descriptor = create_temporary(file, folder);
    int reason = errno;
    free(folder);
    errno = reason;
    return descriptor;
}

// Like `mkdir -p` for what stands before the last slash of `name`, which is changed and changed
// back. False with errno.
static bool make_folders(char *name)
{
    int reason = 0;
    for (char *slash = strchr(name + 1, '/'); slash && !reason; slash = strchr(slash + 1, '/')) {
        *slash = 0;
        struct stat status;
        reason = mkdir(name, 0777) == 0 || errno == EEXIST ? 0 : errno;
        // mkdir can say "no permission" of a folder that is there: what counts is whether a file
        // can be made in it.
        if (reason && stat(name, &status) == 0) reason = 0;
        *slash = '/';
    }
    errno = reason;
    return reason == 0;
}

// Devices and pipes (/dev/stdout) cannot be replaced by renaming: they are written as they are.
static int open_descriptor(OutFile *file)
{
    struct stat status;
    if (stat(file->path, &status) != 0) {
        int descriptor = open_temporary(file);
        if (descriptor >= 0 || errno != ENOENT || !make_folders(file->path)) return descriptor;
        return open_temporary(file);
    }
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
    bool to_stdout = outfile_is_stdout(path);
    if (to_stdout) fflush(stdout);
    int descriptor = to_stdout ? fcntl(STDOUT_FILENO, F_DUPFD_CLOEXEC, 0) : open_descriptor(file);
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

Result outfile_check(OutFile *file, Error *error)
{
    int reason = find_write_error(file);
    return reason ? fail_to_write(file->path, reason, error) : RESULT_OK;
}

static int find_sync_error(OutFile *file)
{
    int reason = find_write_error(file);
    return reason == 0 && file->temporary && fsync(fileno(file->stream)) != 0 ? errno : reason;
}

Result outfile_sync(OutFile *file, Error *error)
{
    int reason = find_sync_error(file);
    return reason ? fail_to_write(file->path, reason, error) : RESULT_OK;
}

Result outfile_commit(OutFile *file, Error *error)
{
    int reason = find_sync_error(file);
    if (fclose(file->stream) != 0 && reason == 0) reason = errno;
    file->stream = NULL;
    if (reason == 0 && file->temporary && rename(file->temporary, file->path) != 0) reason = errno;
    Result result = reason ? fail_to_write(file->path, reason, error) : RESULT_OK;
    if (!reason) {
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
    leftover_forget(file->leftover);
    free(file->temporary);
    free(file->path);
    *file = (OutFile){0};
}

void outfile_scratch_name(char path[PATH_MAX], const char *name)
{
    const char *folder = getenv("TMPDIR");
    snprintf(path, PATH_MAX, "%s/%s-XXXXXX", folder && *folder ? folder : "/tmp", name);
}
