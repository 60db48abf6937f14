// SPDX-License-Identifier: MIT
// Where a file is or will be: a handle of its folder, and its name in there. A path is resolved
// once; what happens to the path afterwards (a folder that becomes a link) changes nothing.
// Functions that return int give 0 or an errno.
#pragma once

#include <stdbool.h>
#include <sys/stat.h>

typedef struct Place {
    int folder;       // handle (O_PATH) of the deepest folder that exists; -1: none
    char *missing;    // the folders that are missing below it, "a/b/"; "": none; owned
    char *name;       // the last part of the path; owned
    bool exists;      // by place_look: a file of that name is there, and `file` describes it
    bool is_link;     // by place_look without `follow`: the name is a link's
    bool is_alias;    // by place_look: the name stands for an open file, as /dev/stdout does
    struct stat file; // of a link that was not followed: the link
    char *made;       // by place_make: the folders at the end that it has made, "a/b/"; owned
} Place;

// Resolves the folder of `path`; the last part is not looked at. ".." behind a folder that is
// missing leads back to where that folder would be. ENOTDIR, EACCES, ENOMEM, ...
int place_find(Place *place, const char *path);

// Looks whether the file is there. `follow`: a link leads on to the place of its target, which need
// not exist. EISDIR: the name is none of a file ("", "..", a slash at its end); ENAMETOOLONG,
// ELOOP, ...
int place_look(Place *place, bool follow);

// Makes the missing folders; none are missing then. `mode`: their permissions less the umask.
int place_make(Place *place, mode_t mode);

// Removes the folders that place_make has made, as far as they are empty.
void place_unmake(Place *place);

// Whether the folder is `home` or lies below it.
bool place_is_within(const Place *place, const struct stat *home);

// A copy with a handle of its own and another name.
int place_copy(Place *copy, const Place *place, const char *name);

// Legal for a place that could not be found.
void place_close(Place *place);

// Whether both describe the same file.
bool place_is_same(const struct stat *a, const struct stat *b);
