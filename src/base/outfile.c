// SPDX-License-Identifier: MIT
#include "base/outfile.h"

#include <errno.h>
#include <fcntl.h>
#include <ftw.h>
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
    return error_set(error, RESULT_FAILED, "%s: cannot write: %s",
                     outfile_is_stdout(path) ? "standard output" : path, strerror(reason));
}

// --- The place of the file.

// Permissions of new folders, before the umask.
enum { PUBLIC = 0777, PRIVATE = 0700 };

// Refuses a file that the run reads, or that it has written as another output.
static Result check_identity(const char *path, const struct stat *file, Error *error)
{
    char other[CLAIMS_PATH_SIZE];
    bool written;
    if (!S_ISREG(file->st_mode) || !claims_find_other(other, &written, path, file))
        return RESULT_OK;
    return error_set(error, RESULT_USAGE,
                     "%.300s: would overwrite %s, which %s: expected another name", path, other,
                     written ? "this run has written" : "is an input");
}

// Whether the claim has already resolved the folder of this path. A claim on a whole folder covers
// subfolders, too, but has not resolved them.
static bool is_resolved(const Claim *claim, const char *path)
{
    return claim && !(claim->whole_folder && strchr(path + strlen(claim->before), '/'));
}

// Checks that the file of a confined claim stays in its folder.
static Result check_confined(const Place *place, const char *path, const Claim *claim, Error *error)
{
    const char *const reasons[][2] = {
        {OUTFILE_IS_LINK, "is a symbolic link, which is not followed"},
        {OUTFILE_IS_OUTSIDE, "is outside the folder"},
        {OUTFILE_IS_NO_FILE, "is a device or a pipe"}};
    int reason = place->is_link                                   ? 0
                 : !place_is_within(place, &claim->home)          ? 1
                 : place->exists && !S_ISREG(place->file.st_mode) ? 2
                                                                  : -1;
    if (reason < 0) return RESULT_OK;
    return error_set(error, RESULT_BAD_INPUT, "%.300s: %s%s", path, reasons[reason][claim->named],
                     claim->named ? ": expected a plain file there" : "");
}

// Whether the claim is on numbered files or a folder. A single file may be a pipe or a device,
// which the user has named.
static bool is_one_of_many(const Claim *claim)
{
    return claim && (claim->after || claim->whole_folder);
}

// Finds where the file of this path goes and what is already there. A claim may have resolved the
// folder.
static Result find_place(Place *place, const char *path, bool follow, Error *error)
{
    const Claim *claim = claims_find(path);
    bool confined = claim && claim->confined;
    const char *slash = strrchr(path, '/'), *name = slash ? slash + 1 : path;
    int reason =
        is_resolved(claim, path) ? place_copy(place, &claim->place, name) : place_find(place, path);
    if (!reason) {
        reason = place_look(place, follow && !confined);
        if (!reason && place->exists && S_ISDIR(place->file.st_mode)) reason = EISDIR;
        if (reason) place_close(place);
    }
    if (reason) return fail_to_write(path, reason, error);
    Result result = confined ? check_confined(place, path, claim, error) : RESULT_OK;
    bool stream = place->exists && !place->is_link && !S_ISREG(place->file.st_mode);
    if (result == RESULT_OK && place->is_link) result = fail_to_write(path, ELOOP, error);
    if (result == RESULT_OK && stream && (!follow || is_one_of_many(claim)))
        result = error_set(error, RESULT_FAILED, "%.300s: " OUTFILE_IS_STREAM, path);
    if (place->exists) THEN(result, check_identity(path, &place->file, error));
    if (result != RESULT_OK) place_close(place);
    return result;
}

// --- Files that appear only when they are complete.

// Creates a new file with a temporary name. mkstemp would set the permissions to 0600. Returns -1
// and sets errno on failure.
static int create_temporary(OutFile *file)
{
    int folder = file->place.folder;
    char name[LEFTOVER_NAME_SIZE];
    leftovers_sweep(folder);
    for (unsigned attempt = 0; attempt < 10000; attempt++) {
        leftovers_name(name, attempt);
        int descriptor = openat(folder, name, O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
        if (descriptor < 0 && errno == EEXIST) continue;
        if (descriptor < 0) return -1;
        flock(descriptor, LOCK_SH | LOCK_NB); // marks the file as in use, for leftovers_sweep
        file->temporary = strdup(name);
        if (file->temporary) {
            file->leftover = leftover_add_file(folder, name);
            return descriptor;
        }
        close(descriptor);
        unlinkat(folder, name, 0);
        errno = ENOMEM;
        return -1;
    }
    return -1;
}

// Devices, pipes and names of open files (/dev/stdout) cannot be replaced by renaming, so they are
// opened directly.
static int open_descriptor(OutFile *file, mode_t folders)
{
    Place *place = &file->place;
    int link = place->is_alias ? 0 : O_NOFOLLOW;
    if (place->is_alias || (place->exists && !S_ISREG(place->file.st_mode)))
        return openat(place->folder, place->name, O_WRONLY | O_CLOEXEC | link);
    // The rename would replace even a read-only file, so check the permission here.
    if (place->exists && faccessat(place->folder, place->name, W_OK, 0) != 0) return -1;
    int reason = place_make(place, folders);
    if (!reason) return create_temporary(file);
    errno = reason;
    return -1;
}

// Finds the place and opens the file. Another run may be removing the folder that it has made
// (ENOENT): then makes it again. Returns -1 with errno on failure, also with a `*result`.
static int find_and_open(OutFile *file, mode_t folders, Result *result, Error *error)
{
    int descriptor = -1;
    for (int i = 0; i < OUTFILE_TRIES && descriptor < 0; ++i) {
        if (i > 0) {
            place_unmake(&file->place);
            place_close(&file->place);
        }
        *result = find_place(&file->place, file->path, folders == PUBLIC, error);
        if (*result != RESULT_OK) break;
        descriptor = open_descriptor(file, folders);
        if (descriptor < 0 && errno != ENOENT) break;
    }
    return descriptor;
}

static Result open_new(OutFile *file, const char *path, mode_t folders, Error *error)
{
    bool to_stdout = outfile_is_stdout(path);
    Result result = RESULT_OK;
    *file = (OutFile){.path = strdup(path), .place = {.folder = -1}};
    if (!file->path) return fail_to_write(path, ENOMEM, error);
    if (to_stdout) fflush(stdout);
    int descriptor = to_stdout ? fcntl(STDOUT_FILENO, F_DUPFD_CLOEXEC, 0)
                               : find_and_open(file, folders, &result, error);
    int reason = errno;
    if (descriptor >= 0) {
        file->stream = fdopen(descriptor, "wb");
        reason = errno;
        if (!file->stream) close(descriptor);
    }
    if (file->stream) return RESULT_OK;
    place_unmake(&file->place);
    outfile_discard(file);
    return result != RESULT_OK ? result : fail_to_write(path, reason, error);
}

Result outfile_open(OutFile *file, const char *path, Error *error)
{
    Claim *claim = claims_find(path);
    if (!claim || !claim->started) return open_new(file, path, PUBLIC, error);
    OutFile *started = claim->started;
    claim->started = NULL;
    *file = *started;
    free(started);
    return RESULT_OK;
}

Result outfile_open_private(OutFile *file, const char *path, Error *error)
{
    return open_new(file, path, PRIVATE, error);
}

Result outfile_try(const char *path, Error *error)
{
    OutFile probe;
    const Claim *claim = claims_find(path);
    if (claim && claim->started) return RESULT_OK;
    TRY(outfile_open(&probe, path, error));
    outfile_discard(&probe);
    return RESULT_OK;
}

int outfile_try_folder(const Place *place)
{
    OutFile probe = {0};
    int reason = place_copy(&probe.place, place, "");
    int descriptor = reason ? -1 : create_temporary(&probe);
    if (!reason && descriptor < 0) reason = errno;
    if (descriptor >= 0) close(descriptor);
    outfile_discard(&probe);
    return reason;
}

// A stream remembers that a write failed, but not why. The file is lost anyway, so write one more
// byte to get the errno again.
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

// Gives the file its final name, after checking once more what has that name now. Returns 0 or an
// errno, or -1 if the error is set.
static int rename_temporary(OutFile *file, const struct stat *written, Error *error)
{
    const Place *place = &file->place;
    struct stat now;
    if (fstatat(place->folder, place->name, &now, AT_SYMLINK_NOFOLLOW) == 0 &&
        check_identity(file->path, &now, error) != RESULT_OK)
        return -1;
    if (renameat(place->folder, file->temporary, place->folder, place->name) != 0) return errno;
    claims_note_output(file->path, written);
    return 0;
}

Result outfile_commit(OutFile *file, Error *error)
{
    struct stat written;
    int reason = find_sync_error(file);
    if (reason == 0 && file->temporary && fstat(fileno(file->stream), &written) != 0)
        reason = errno;
    if (fclose(file->stream) != 0 && reason == 0) reason = errno;
    file->stream = NULL;
    if (reason == 0 && file->temporary) reason = rename_temporary(file, &written, error);
    Result result = reason < 0 ? RESULT_USAGE
                    : reason   ? fail_to_write(file->path, reason, error)
                               : RESULT_OK;
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
    if (file->temporary) unlinkat(file->place.folder, file->temporary, 0);
    leftover_forget(file->leftover);
    place_close(&file->place);
    free(file->temporary);
    free(file->path);
    *file = (OutFile){0};
}

Result outfile_start(Claim *claim, Error *error)
{
    OutFile *file = malloc(sizeof *file);
    if (!file) return fail_to_write(claim->before, ENOMEM, error);
    Result result = open_new(file, claim->before, PUBLIC, error);
    if (result == RESULT_OK && !outfile_is_stdout(claim->before)) {
        // A pipe stays open, too: closing it would look like the end to its reader.
        claim->started = file;
        return RESULT_OK;
    }
    if (result == RESULT_OK) outfile_discard(file);
    free(file);
    return result;
}

void outfile_end(void)
{
    for (Claim *claim = claims_next(NULL); claim; claim = claims_next(claim)) {
        OutFile *file = claim->started;
        if (!file) continue;
        if (file->temporary) unlinkat(file->place.folder, file->temporary, 0);
        place_unmake(&file->place);
        outfile_discard(file);
        free(file);
        claim->started = NULL;
    }
    claims_end();
}

// --- Files that are written in place.

static Result open_as_it_is(int *descriptor, const char *path, int flags, Error *error)
{
    Place place;
    struct stat file;
    *descriptor = -1;
    TRY(find_place(&place, path, true, error));
    int link = place.is_alias ? 0 : O_NOFOLLOW, reason = place_make(&place, PUBLIC);
    if (!reason) {
        *descriptor = openat(place.folder, place.name, flags | O_CREAT | O_CLOEXEC | link, 0666);
        if (*descriptor < 0 || fstat(*descriptor, &file) != 0) reason = errno;
    }
    place_close(&place);
    Result result =
        reason ? fail_to_write(path, reason, error) : check_identity(path, &file, error);
    if (result == RESULT_OK) {
        claims_note_output(path, &file);
        return result;
    }
    if (*descriptor >= 0) close(*descriptor);
    *descriptor = -1;
    return result;
}

Result outfile_open_kept(int *descriptor, const char *path, Error *error)
{
    return open_as_it_is(descriptor, path, O_RDWR, error);
}

// Writes all bytes, even if signals interrupt.
static bool write_all(int descriptor, const char *text, size_t size)
{
    while (size) {
        ssize_t written = write(descriptor, text, size);
        if (written < 0 && errno != EINTR) return false;
        if (written > 0) text += written, size -= (size_t)written;
    }
    return true;
}

Result outfile_append(const char *path, const char *text, Error *error)
{
    int descriptor;
    TRY(open_as_it_is(&descriptor, path, O_WRONLY | O_APPEND, error));
    int reason = write_all(descriptor, text, strlen(text)) ? 0 : errno;
    if (close(descriptor) != 0 && !reason) reason = errno;
    return reason ? fail_to_write(path, reason, error) : RESULT_OK;
}

Result outfile_remove(const char *path, Error *error)
{
    Place place;
    const Claim *claim = claims_find(path);
    int reason = claim && !claim->whole_folder
                     ? place_copy(&place, &claim->place, claim->place.name)
                     : place_find(&place, path);
    if (!reason && claim && claim->confined && !place_is_within(&place, &claim->home)) {
        place_close(&place);
        return error_set(error, RESULT_BAD_INPUT, "%.300s: is outside the folder", path);
    }
    if (!reason) {
        bool gone = *place.missing || unlinkat(place.folder, place.name, 0) == 0;
        reason = gone || errno == ENOENT ? 0 : errno;
        place_close(&place);
    }
    if (!reason) return RESULT_OK;
    return error_set(error, RESULT_FAILED, "%s: cannot remove it: %s", path, strerror(reason));
}

static void name_scratch(char path[PATH_MAX], const char *name)
{
    const char *folder = getenv("TMPDIR");
    snprintf(path, PATH_MAX, "%s/%s-XXXXXX", folder && *folder ? folder : "/tmp", name);
}

FILE *outfile_open_scratch(void)
{
    char path[PATH_MAX];
    name_scratch(path, "tractrix");
    int file = mkstemp(path);
    if (file < 0) return NULL;
    unlink(path);
    FILE *stream = fdopen(file, "w+");
    if (!stream) close(file);
    return stream;
}

Result outfile_make_scratch(char path[PATH_MAX], const char *name, Error *error)
{
    name_scratch(path, name);
    int file = mkstemp(path);
    if (file < 0) return error_set(error, RESULT_FAILED, "%s: %s", path, strerror(errno));
    close(file);
    return RESULT_OK;
}

Result outfile_make_scratch_folder(char path[PATH_MAX], const char *name, Error *error)
{
    name_scratch(path, name);
    if (mkdtemp(path)) return RESULT_OK;
    return error_set(error, RESULT_FAILED, "%s: %s", path, strerror(errno));
}

static int remove_entry(const char *path, const struct stat *status, int kind, struct FTW *walk)
{
    (void)status, (void)kind, (void)walk;
    return remove(path);
}

void outfile_remove_scratch_folder(const char *path)
{
    nftw(path, remove_entry, 16, FTW_DEPTH | FTW_PHYS);
}
