// SPDX-License-Identifier: MIT
#include "base/paths.h"

#include "base/outfile.h"
#include "base/place.h"
#include "base/target.h"

#include <dirent.h>
#include <errno.h>
#include <fcntl.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include <sys/stat.h>
#include <unistd.h>

// A path use with the result of looking at the file system.
typedef struct Spot {
    bool used, exists, numbered;
    struct stat file, folder; // `file` is set if it exists, after following links
    Place place;              // links are followed, except for numbered files and folders
    // Owned. The path below `folder`; for a numbered file up to the number.
    char *rest;
    // Owned. For a numbered file: the text after the number.
    char *after;
} Spot;

static bool is_written(PathRole role)
{
    return role != PATH_READ && role != PATH_UPDATED;
}

static void destroy_spot(Spot *spot)
{
    place_close(&spot->place);
    free(spot->rest);
    free(spot->after);
}

// Parses the path. A numbered path sets `before` and `after` of the target.
static void parse(Target *target, const PathUse *use, bool exists)
{
    bool known = use->role == PATH_TARGET && target_parse(target, use->path, NULL) == RESULT_OK;
    bool pattern = use->role == PATH_TARGET || (!is_written(use->role) && !exists);
    if (!known && pattern && strchr(use->path, '%')) target_parse_any(target, use->path, NULL);
}

// A copy of the path without trailing slashes; the caller frees it.
static char *strip(const char *path)
{
    size_t length = strlen(path);
    while (length > 1 && path[length - 1] == '/') --length;
    return strndup(path, length);
}

// Sets place and rest. Returns 0 or an errno.
static int find_place(Spot *spot, const char *path, bool follow)
{
    int reason = place_find(&spot->place, path);
    if (!reason && !spot->numbered) reason = place_look(&spot->place, follow);
    // A path such as ".." that names no file is left to the reader or writer to refuse.
    if (reason && (reason != EISDIR || !spot->place.missing)) return reason;
    // A path with ".." behind a missing folder exists here, too, although stat failed.
    if (spot->place.exists && !spot->place.is_link) {
        spot->exists = true;
        spot->file = spot->place.file;
    }
    if (fstat(spot->place.folder, &spot->folder) != 0) return errno;
    if (asprintf(&spot->rest, "%s%s", spot->place.missing, spot->place.name) < 0) spot->rest = NULL;
    return spot->rest ? 0 : ENOMEM;
}

// Looks at the path of a use. Returns 0 or an errno.
static int look(Spot *spot, const PathUse *use)
{
    Target target = {0};
    *spot = (Spot){.place = {.folder = -1}};
    spot->used = use->path && *use->path && strcmp(use->path, "-") != 0;
    if (!spot->used) return 0;
    bool exists = stat(use->path, &spot->file) == 0;
    parse(&target, use, exists);
    spot->numbered = target.before && target.kind == TARGET_FRAMES;
    spot->exists = exists && !spot->numbered;
    bool plain = !is_written(use->role) || use->role == PATH_FOLDER;
    char *path = spot->numbered ? strdup(target.before)
                 : plain        ? strip(use->path)
                                : strdup(use->path);
    if (spot->numbered) spot->after = strdup(target.after);
    bool room = path && (!spot->numbered || spot->after);
    int reason = room ? find_place(spot, path, !use->home && use->role != PATH_FOLDER) : ENOMEM;
    // If an input cannot be reached, its reader reports that.
    if (reason && reason != ENOMEM && !is_written(use->role)) {
        spot->used = spot->exists;
        reason = 0;
    }
    free(path);
    target_destroy(&target);
    return reason;
}

// --- Which paths are the same file.

// Whether `name` is `before`, digits, then `after`.
static bool is_numbered(const char *name, const char *before, const char *after)
{
    size_t length = strlen(before);
    if (strncasecmp(name, before, length) != 0) return false;
    size_t digits = strspn(name + length, "0123456789");
    return digits > 0 && strcasecmp(name + length + digits, after) == 0;
}

// Whether one file name can match both patterns.
static bool patterns_meet(const Spot *a, const Spot *b)
{
    size_t length = strlen(a->rest);
    if (length > strlen(b->rest)) return patterns_meet(b, a);
    return strcasecmp(a->after, b->after) == 0 && strncasecmp(a->rest, b->rest, length) == 0 &&
           strspn(b->rest + length, "0123456789") == strlen(b->rest) - length;
}

static bool is_folder(const Spot *spot)
{
    return spot->exists && S_ISDIR(spot->file.st_mode);
}

// Whether `folder` is a folder that directly contains the file or files of `spot`.
static bool lies_in(const Spot *spot, const Spot *folder)
{
    return is_folder(folder) && spot->rest && !strchr(spot->rest, '/') &&
           place_is_same(&spot->folder, &folder->file);
}

static bool are_one(const Spot *a, const Spot *b)
{
    if ((a->numbered && lies_in(a, b)) || (b->numbered && lies_in(b, a))) return true;
    if (a->exists && b->exists && place_is_same(&a->file, &b->file))
        return S_ISREG(a->file.st_mode) || S_ISDIR(a->file.st_mode);
    if (!a->rest || !b->rest || !place_is_same(&a->folder, &b->folder)) return false;
    if (a->numbered && b->numbered) return patterns_meet(a, b);
    if (a->numbered) return is_numbered(b->rest, a->rest, a->after);
    if (b->numbered) return is_numbered(a->rest, b->rest, b->after);
    // On a file system that ignores case, two spellings are one file. If one exists and the other
    // does not, they are two files.
    return !a->exists && !b->exists && strcasecmp(a->rest, b->rest) == 0;
}

static Result compare(const PathUse *use, const PathUse *other, Error *error)
{
    if (is_written(other->role))
        return error_set(error, RESULT_USAGE,
                         "%s %.300s and %s %.300s would write the same file: "
                         "expected two names",
                         use->name, use->path, other->name, other->path);
    return error_set(error, RESULT_USAGE,
                     "%s %.300s would overwrite %s %.300s: expected another name", use->name,
                     use->path, other->name, other->path);
}

// The uses to compare with each other.
typedef struct Uses {
    const PathUse *uses;
    Spot *spots;
    int count;
} Uses;

// Compares a file or pattern that use `i` writes with all other uses. `once` compares each pair of
// outputs only once.
static Result compare_all(const Uses *all, int i, const Spot *spot, bool once, Error *error)
{
    const PathUse *uses = all->uses;
    for (int k = 0; k < all->count; ++k) {
        const Spot *other = &all->spots[k];
        bool wanted = !once || k > i || !is_written(uses[k].role); // each pair of outputs once
        if (k != i && wanted && other->used && are_one(spot, other))
            return compare(&uses[i], &uses[k], error);
    }
    return RESULT_OK;
}

// --- Checking one output.

static Result fail(const PathUse *use, int reason, Error *error)
{
    return error_set(error, RESULT_FAILED, "%s %.300s: cannot write: %s", use->name, use->path,
                     strerror(reason));
}

// Whether a file that exists is a device or a pipe: a link that was not followed is none.
static bool is_no_file(const struct stat *file)
{
    return !S_ISREG(file->st_mode) && !S_ISDIR(file->st_mode) && !S_ISLNK(file->st_mode);
}

// Checks an output that a scene file names: it must be within the scene file's folder, and neither
// a link, nor a device or pipe.
static Result check_home(const Spot *spot, const PathUse *use, struct stat *home, Error *error)
{
    Place place;
    int reason = place_find(&place, use->home);
    if (!reason && fstat(place.folder, home) != 0) reason = errno;
    place_close(&place);
    if (reason) return fail(use, reason, error);
    if (!place_is_within(&spot->place, home))
        return error_set(error, RESULT_BAD_INPUT, "%.300s: %s %.300s " OUTFILE_IS_OUTSIDE,
                         use->home, use->name, use->path);
    if (spot->place.is_link)
        return error_set(error, RESULT_BAD_INPUT, "%.300s: %s %.300s " OUTFILE_IS_LINK, use->home,
                         use->name, use->path);
    if (spot->exists && is_no_file(&spot->file))
        return error_set(error, RESULT_BAD_INPUT, "%.300s: %s %.300s " OUTFILE_IS_NO_FILE,
                         use->home, use->name, use->path);
    return RESULT_OK;
}

// Checks a link that already exists under the name of one of the numbered files.
static Result check_link(const Uses *all, int i, const char *name, Error *error)
{
    const PathUse *use = &all->uses[i];
    const Place *folder = &all->spots[i].place;
    Spot spot = {.used = true, .place = {.folder = -1}};
    if (use->home)
        return error_set(error, RESULT_BAD_INPUT, "%.300s: %s %.300s: %.200s " OUTFILE_IS_LINK,
                         use->home, use->name, use->path, name);
    int reason = place_copy(&spot.place, folder, name);
    if (!reason) reason = place_look(&spot.place, true);
    if (!reason && fstat(spot.place.folder, &spot.folder) != 0) reason = errno;
    spot.exists = spot.place.exists;
    spot.file = spot.place.file;
    if (!reason && asprintf(&spot.rest, "%s%s", spot.place.missing, spot.place.name) < 0) {
        spot.rest = NULL;
        reason = ENOMEM;
    }
    Result result = reason ? fail(use, reason, error) : compare_all(all, i, &spot, false, error);
    destroy_spot(&spot);
    return result;
}

static Result check_links(const Uses *all, int i, Error *error)
{
    const Spot *spot = &all->spots[i];
    if (!spot->numbered || *spot->place.missing) return RESULT_OK;
    int folder = openat(spot->place.folder, ".", O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    DIR *directory = folder < 0 ? NULL : fdopendir(folder);
    if (!directory) { // the folder may be writable but not readable
        if (folder >= 0) close(folder);
        return RESULT_OK;
    }
    Result result = RESULT_OK;
    struct stat file;
    for (const struct dirent *entry; result == RESULT_OK && (entry = readdir(directory));)
        if (is_numbered(entry->d_name, spot->place.name, spot->after) &&
            fstatat(folder, entry->d_name, &file, AT_SYMLINK_NOFOLLOW) == 0 &&
            S_ISLNK(file.st_mode))
            result = check_link(all, i, entry->d_name, error);
    closedir(directory);
    return result;
}

// Checks permissions before anything is read. A device or a pipe is written in place, so it needs
// no permission in its folder.
static Result check_open(const Spot *spot, const PathUse *use, Error *error)
{
    const Place *place = &spot->place;
    bool plain = spot->exists && S_ISREG(spot->file.st_mode);
    int reason = 0;
    if (spot->exists && S_ISDIR(spot->file.st_mode) && use->role != PATH_FOLDER) reason = EISDIR;
    if ((!spot->exists || (plain && use->role != PATH_KEPT)) &&
        faccessat(place->folder, ".", W_OK | X_OK, 0) != 0)
        reason = errno;
    if (plain && faccessat(place->folder, place->name, W_OK, 0) != 0) reason = errno;
    return reason ? fail(use, reason, error) : RESULT_OK;
}

static Result check_all(const Uses *all, Error *error)
{
    Result result = RESULT_OK;
    for (int i = 0; i < all->count && result == RESULT_OK; ++i) {
        int reason = look(&all->spots[i], &all->uses[i]);
        if (reason) result = fail(&all->uses[i], reason, error);
    }
    for (int i = 0; i < all->count && result == RESULT_OK; ++i) {
        struct stat home;
        if (all->spots[i].used && all->uses[i].home)
            result = check_home(&all->spots[i], &all->uses[i], &home, error);
    }
    for (int i = 0; i < all->count && result == RESULT_OK; ++i) {
        if (!all->spots[i].used || !is_written(all->uses[i].role)) continue;
        result = compare_all(all, i, &all->spots[i], true, error);
        THEN(result, check_links(all, i, error));
    }
    for (int i = 0; i < all->count && result == RESULT_OK; ++i)
        if (all->spots[i].used && is_written(all->uses[i].role))
            result = check_open(&all->spots[i], &all->uses[i], error);
    return result;
}

// --- Claims.

// Makes the folder, holds it and checks that a file can be created in it. Another run may be
// removing the folder that it has made (ENOENT): then makes it again.
static Result try_folder(Claim *claim, const PathUse *use, Error *error)
{
    int reason = ENOENT;
    for (int i = 0; i < OUTFILE_TRIES && reason == ENOENT; ++i) {
        if (i > 0) {
            place_close(&claim->place);
            reason = place_find(&claim->place, claim->before);
            if (reason) break;
        }
        reason = place_make(&claim->place, 0777);
        if (reason) continue;
        place_hold(&claim->place);
        reason = outfile_try_folder(&claim->place);
    }
    return reason ? fail(use, reason, error) : RESULT_OK;
}

// Sets the path of the claim and the place of its folder. Returns 0 or an errno.
static int find_claim(Claim *claim, const Spot *spot, const PathUse *use)
{
    Target target = {0};
    char *path = strip(use->path);
    claim->whole_folder =
        use->role == PATH_FOLDER || (use->role == PATH_UPDATED && is_folder(spot));
    parse(&target, use, spot->exists);
    if (claim->whole_folder && path)
        claim->before = strcmp(path, "/") == 0 ? strdup(path) : NULL;
    else
        claim->before = strdup(spot->numbered ? target.before : use->path);
    if (claim->whole_folder && path && !claim->before && asprintf(&claim->before, "%s/", path) < 0)
        claim->before = NULL;
    if (spot->numbered) claim->after = strdup(target.after);
    target_destroy(&target);
    free(path);
    bool room = claim->before && (!spot->numbered || claim->after);
    return room ? place_find(&claim->place, claim->before) : ENOMEM;
}

static Result claim_one(const Spot *spot, const PathUse *use, Error *error)
{
    Claim claim = {.name = use->name, .confined = use->home, .place = {.folder = -1}};
    if (use->home) TRY(check_home(spot, use, &claim.home, error));
    int reason = find_claim(&claim, spot, use);
    if (!reason && use->role == PATH_UPDATED && (claim.whole_folder || claim.after)) {
        claim.confined = claim.named = true;
        if (fstat(claim.place.folder, &claim.home) != 0) reason = errno;
    }
    Claim *kept = reason ? NULL : claims_add(&claim);
    if (!kept) {
        place_close(&claim.place);
        free(claim.before);
        free(claim.after);
        return fail(use, reason ? reason : ENOMEM, error);
    }
    if (use->role == PATH_UPDATED || use->role == PATH_KEPT) return RESULT_OK;
    if (spot->numbered || use->role == PATH_FOLDER) return try_folder(kept, use, error);
    Result result = outfile_start(kept, error);
    return result == RESULT_OK ? result : error_prefix(error, result, "%s ", use->name);
}

static Result claim_all(const Uses *all, Error *error)
{
    Result result = RESULT_OK;
    for (int i = 0; i < all->count && result == RESULT_OK; ++i)
        if (all->spots[i].used && all->uses[i].role != PATH_READ)
            result = claim_one(&all->spots[i], &all->uses[i], error);
    for (int i = 0; i < all->count && result == RESULT_OK; ++i)
        if (all->spots[i].exists && all->uses[i].role == PATH_READ)
            claims_note_input(all->uses[i].path, &all->spots[i].file);
    return result;
}

static Result check(const PathUse *uses, int count, bool claims, Error *error)
{
    Uses all = {uses, calloc((size_t)count + 1, sizeof *all.spots), count};
    if (!all.spots) return error_set(error, RESULT_FAILED, "no memory for paths");
    for (int i = 0; i < count; ++i) all.spots[i].place.folder = -1;
    Result result = check_all(&all, error);
    if (claims) THEN(result, claim_all(&all, error));
    for (int i = 0; i < count; ++i) destroy_spot(&all.spots[i]);
    free(all.spots);
    return result;
}

Result paths_check(const PathUse *uses, int count, Error *error)
{
    return check(uses, count, false, error);
}

Result paths_claim(const PathUse *uses, int count, Error *error)
{
    return check(uses, count, true, error);
}
