// SPDX-License-Identifier: MIT
#include "base/paths.h"

#include "base/target.h"

#include <errno.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include <sys/stat.h>
#include <unistd.h>

// Where a file is: the deepest folder that exists, and the path below it.
typedef struct Place {
    bool used, exists, numbered;
    int closed;               // why no file can be made in `folder`; 0 if one can
    struct stat file, folder; // `file` if it exists
    char *full;               // owned; the path, links followed if it exists
    const char *rest;         // of a numbered one up to the number
    char *after;              // owned; of a numbered one, behind the number
} Place;

static void destroy_place(Place *place)
{
    free(place->full);
    free(place->after);
}

// Whether `name` is there; then sets folder and why it takes no files.
static bool look_at_folder(Place *place, const char *name)
{
    if (stat(name, &place->folder) != 0) return false;
    if (access(name, W_OK | X_OK) != 0) place->closed = errno;
    if (!S_ISDIR(place->folder.st_mode)) place->closed = ENOTDIR;
    return true;
}

// Sets folder and rest of `full`.
static bool find_folder(Place *place)
{
    char *full = place->full;
    for (char *slash = strrchr(full, '/'); slash;
         slash = memrchr(full, '/', (size_t)(slash - full))) {
        *slash = 0;
        bool there = look_at_folder(place, *full ? full : "/");
        *slash = '/';
        place->rest = slash + 1;
        if (there) return true;
    }
    place->rest = full;
    return look_at_folder(place, ".");
}

// False with errno.
static bool find_place(Place *place, const PathUse *use)
{
    Target target = {0};
    errno = 0;
    *place = (Place){.used = use->path && *use->path && strcmp(use->path, "-") != 0};
    if (!place->used) return true;
    bool file = stat(use->path, &place->file) == 0;
    bool pattern = !file && strchr(use->path, '%');
    if (use->role == PATH_WRITTEN ? target_parse(&target, use->path, NULL) != RESULT_OK : pattern)
        target_parse_any(&target, use->path, NULL);
    place->numbered = target.before && target.kind == TARGET_FRAMES;
    place->exists = !place->numbered && file;
    if (place->exists) place->full = realpath(use->path, NULL);
    if (!place->full) place->full = strdup(place->numbered ? target.before : use->path);
    if (place->numbered) place->after = strdup(target.after);
    target_destroy(&target);
    if (!place->full || (place->numbered && !place->after)) errno = ENOMEM;
    return errno != ENOMEM && find_folder(place);
}

static bool is_same(const struct stat *a, const struct stat *b)
{
    return a->st_dev == b->st_dev && a->st_ino == b->st_ino;
}

// Whether `name` is `before`, digits, `after`.
static bool is_numbered(const char *name, const char *before, const char *after)
{
    size_t length = strlen(before);
    if (strncasecmp(name, before, length) != 0) return false;
    size_t digits = strspn(name + length, "0123456789");
    return digits > 0 && strcasecmp(name + length + digits, after) == 0;
}

// Whether a file may belong to both patterns.
static bool patterns_meet(const Place *a, const Place *b)
{
    size_t length = strlen(a->rest);
    if (length > strlen(b->rest)) return patterns_meet(b, a);
    return strcasecmp(a->after, b->after) == 0 && strncasecmp(a->rest, b->rest, length) == 0 &&
           strspn(b->rest + length, "0123456789") == strlen(b->rest) - length;
}

// Whether `folder` is one that is read, and the files of `place` go into it.
static bool goes_into(const Place *place, const Place *folder)
{
    return folder->exists && S_ISDIR(folder->file.st_mode) && place->numbered &&
           is_same(&place->folder, &folder->file);
}

static bool are_one(const Place *a, const Place *b)
{
    if (goes_into(a, b) || goes_into(b, a)) return true;
    if (a->exists && b->exists) return S_ISREG(a->file.st_mode) && is_same(&a->file, &b->file);
    if (!is_same(&a->folder, &b->folder)) return false;
    if (a->numbered && b->numbered) return patterns_meet(a, b);
    if (a->numbered) return is_numbered(b->rest, a->rest, a->after);
    if (b->numbered) return is_numbered(a->rest, b->rest, b->after);
    // Of two spellings, one that exists and one that doesn't are two files.
    return !a->exists && !b->exists && strcasecmp(a->rest, b->rest) == 0;
}

static Result compare(const PathUse *use, const PathUse *other, Error *error)
{
    if (other->role == PATH_WRITTEN)
        return error_set(error, RESULT_USAGE,
                         "%s %.300s and %s %.300s would write the same file: "
                         "expected two names",
                         use->name, use->path, other->name, other->path);
    return error_set(error, RESULT_USAGE,
                     "%s %.300s would overwrite %s %.300s: expected another name", use->name,
                     use->path, other->name, other->path);
}

// What can be told before anything is read; a file that is there may still be one's own in a folder
// that isn't, if it is written as it is (a device, a pipe).
static Result check_open(const Place *place, const PathUse *use, Error *error)
{
    bool replaced = !place->exists || S_ISREG(place->file.st_mode);
    int reason = replaced ? place->closed : 0;
    if (place->exists && S_ISREG(place->file.st_mode) && access(use->path, W_OK) != 0)
        reason = errno;
    if (!place->used || use->role != PATH_WRITTEN || !reason) return RESULT_OK;
    return error_set(error, RESULT_FAILED, "%s %.300s: cannot write: %s", use->name, use->path,
                     strerror(reason));
}

Result paths_check(const PathUse *uses, int count, Error *error)
{
    Place *places = calloc((size_t)count + 1, sizeof *places);
    bool found = places != NULL;
    Result result = found ? RESULT_OK : error_set(error, RESULT_FAILED, "no memory for paths");
    for (int i = 0; i < count && found; ++i) {
        found = find_place(&places[i], &uses[i]);
        if (!found)
            result = error_set(error, RESULT_FAILED, "%s %.300s: cannot look at its folder: %s",
                               uses[i].name, uses[i].path, strerror(errno));
    }
    for (int i = 0; i < count && found; ++i)
        for (int k = 0; k < count && uses[i].role == PATH_WRITTEN; ++k) {
            bool once = k > i || uses[k].role == PATH_READ; // each pair of outputs once
            if (result == RESULT_OK && once && i != k && places[i].used && places[k].used &&
                are_one(&places[i], &places[k]))
                result = compare(&uses[i], &uses[k], error);
        }
    for (int i = 0; i < count && result == RESULT_OK; ++i)
        result = check_open(&places[i], &uses[i], error);
    for (int i = 0; i < count && places; ++i) destroy_place(&places[i]);
    free(places);
    return result;
}
