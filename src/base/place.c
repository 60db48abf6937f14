// SPDX-License-Identifier: MIT
#include "base/place.h"

#include <errno.h>
#include <fcntl.h>
#include <limits.h>
#include <stdlib.h>
#include <string.h>
#include <sys/file.h>
#include <unistd.h>

enum { MOST_LINKS = 40 }; // the limit of Linux

static int open_folder(int at, const char *name)
{
    return openat(at, name, O_PATH | O_DIRECTORY | O_CLOEXEC);
}

// Cuts the slash at the end of a text like "a/b/" and returns its last name.
static char *pop(char *folders)
{
    folders[strlen(folders) - 1] = 0;
    char *slash = strrchr(folders, '/');
    return slash ? slash + 1 : folders;
}

// Enters the folder `name`, or appends it to the missing folders.
static int step(Place *place, const char *name)
{
    bool up = strcmp(name, "..") == 0;
    if (strcmp(name, ".") == 0) return 0;
    if (*place->missing && up) {
        *pop(place->missing) = 0;
        return 0;
    }
    int next = *place->missing ? -1 : open_folder(place->folder, name);
    if (next >= 0) {
        close(place->folder);
        place->folder = next;
        return 0;
    }
    if (!*place->missing && (up || errno != ENOENT)) return errno;
    strcat(strcat(place->missing, name), "/"); // `missing` has room for the whole path
    return 0;
}

// Like place_find, but relative to the folder `at`, which may be AT_FDCWD.
static int find_from(Place *place, int at, const char *path)
{
    *place = (Place){.folder = open_folder(at, *path == '/' ? "/" : ".")};
    if (place->folder < 0) return errno;
    const char *slash = strrchr(path, '/');
    size_t length = slash ? (size_t)(slash - path) : 0;
    place->missing = calloc(1, length + 2);
    place->name = strdup(slash ? slash + 1 : path);
    char *folders = strndup(path, length), *rest = NULL;
    int reason = place->missing && place->name && folders ? 0 : ENOMEM;
    char *name = reason ? NULL : strtok_r(folders, "/", &rest);
    for (; name && !reason; name = strtok_r(NULL, "/", &rest)) reason = step(place, name);
    free(folders);
    if (reason) place_close(place);
    return reason;
}

int place_find(Place *place, const char *path)
{
    return find_from(place, AT_FDCWD, path);
}

// Moves the place to the target of the link.
static int follow_link(Place *place)
{
    char target[PATH_MAX];
    ssize_t length = readlinkat(place->folder, place->name, target, sizeof target - 1);
    if (length < 0) return errno;
    target[length] = 0;
    Place next;
    int reason = find_from(&next, place->folder, target);
    if (reason) return reason;
    place_close(place);
    *place = next;
    return 0;
}

// Looks up the name without following links.
static int look(Place *place)
{
    const char *name = place->name;
    if (!*name || strcmp(name, ".") == 0 || strcmp(name, "..") == 0) return EISDIR;
    if (strlen(name) > NAME_MAX) return ENAMETOOLONG;
    place->exists =
        !*place->missing && fstatat(place->folder, name, &place->file, AT_SYMLINK_NOFOLLOW) == 0;
    if (!place->exists && !*place->missing && errno != ENOENT) return errno;
    place->is_link = place->exists && S_ISLNK(place->file.st_mode);
    return 0;
}

int place_look(Place *place, bool follow)
{
    struct stat open_file;
    Place first = {.folder = -1};
    int reason = look(place), links = 0;
    if (reason || !place->is_link || !follow) return reason;
    bool leads = fstatat(place->folder, place->name, &open_file, 0) == 0;
    reason = place_copy(&first, place, place->name);
    while (!reason && place->is_link) {
        reason = ++links > MOST_LINKS ? ELOOP : follow_link(place);
        if (!reason) reason = look(place);
    }
    // Links in /proc may name a target without a name, or with another file's name. Then stay at
    // the link and mark it as an alias of the open file.
    bool found = !reason && place->exists && place_is_same(&place->file, &open_file);
    if (leads && !found && first.folder >= 0) {
        Place swap = *place;
        *place = first;
        first = swap;
        place->exists = place->is_alias = true;
        place->file = open_file;
        reason = 0;
    }
    place_close(&first);
    return reason;
}

int place_make(Place *place, mode_t mode)
{
    int reason = 0;
    char *rest = NULL, *folders = strdup(place->missing);
    char *made = calloc(1, strlen(place->missing) + 1);
    if (!folders || !made) reason = ENOMEM;
    char *name = reason ? NULL : strtok_r(folders, "/", &rest);
    for (; name && !reason; name = strtok_r(NULL, "/", &rest)) {
        bool own = mkdirat(place->folder, name, mode) == 0;
        int why = own || errno == EEXIST ? 0 : errno;
        // mkdirat may fail with "permission denied" although the folder exists.
        int next = open_folder(place->folder, name);
        if (next < 0) {
            reason = why ? why : errno;
            break;
        }
        close(place->folder);
        place->folder = next;
        if (own)
            strcat(strcat(made, name), "/");
        else
            *made = 0;
    }
    free(folders);
    free(place->made);
    place->made = made;
    if (!reason) *place->missing = 0;
    return reason;
}

// Opens the folder again, since a handle by O_PATH takes no lock. -1 with errno.
static int open_for_lock(const Place *place)
{
    return openat(place->folder, ".", O_RDONLY | O_DIRECTORY | O_CLOEXEC);
}

void place_hold(Place *place)
{
    int folder = open_for_lock(place);
    if (folder < 0) return;
    while (flock(folder, LOCK_SH) != 0 && errno == EINTR) continue;
    close(place->folder);
    place->folder = folder;
}

// Whether no other process holds the folder; if so, none can hold it until `*lock` is closed.
static bool hold_alone(Place *place, int *lock)
{
    flock(place->folder, LOCK_UN); // its own lock, if it has one
    *lock = open_for_lock(place);
    return *lock >= 0 && flock(*lock, LOCK_EX | LOCK_NB) == 0;
}

void place_unmake(Place *place)
{
    while (place->made && *place->made) {
        int lock;
        bool alone = hold_alone(place, &lock);
        char *name = pop(place->made);
        int above = open_folder(place->folder, "..");
        bool gone = alone && above >= 0 && unlinkat(above, name, AT_REMOVEDIR) == 0;
        if (lock >= 0) close(lock);
        *name = 0; // now ends with the slash of the parent folder
        if (!gone) *place->made = 0;
        if (above < 0) continue;
        close(place->folder);
        place->folder = above;
    }
}

bool place_is_within(const Place *place, const struct stat *home)
{
    struct stat here, above = {0};
    int folder = fcntl(place->folder, F_DUPFD_CLOEXEC, 0);
    bool within = false, top = folder < 0 || fstat(folder, &here) != 0;
    while (!top && !(within = place_is_same(&here, home))) {
        int next = open_folder(folder, "..");
        top = next < 0 || fstat(next, &above) != 0 || place_is_same(&here, &above);
        close(folder);
        folder = next;
        here = above;
    }
    if (folder >= 0) close(folder);
    return within;
}

int place_copy(Place *copy, const Place *place, const char *name)
{
    *copy = (Place){.folder = fcntl(place->folder, F_DUPFD_CLOEXEC, 0)};
    if (copy->folder < 0) return errno;
    copy->missing = strdup(place->missing);
    copy->name = strdup(name);
    if (copy->missing && copy->name) return 0;
    place_close(copy);
    return ENOMEM;
}

void place_close(Place *place)
{
    if (place->missing && place->folder >= 0) close(place->folder);
    free(place->missing);
    free(place->made);
    free(place->name);
    *place = (Place){.folder = -1};
}

bool place_is_same(const struct stat *a, const struct stat *b)
{
    return a->st_dev == b->st_dev && a->st_ino == b->st_ino;
}
