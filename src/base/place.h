// SPDX-License-Identifier: MIT
// The place of a file that exists or will be written: a handle of its folder, and its name there. A
// path is resolved once; later changes of the path (a folder that becomes a link) have no effect.
// Functions that return int return 0 or an errno.
#pragma once

#include <stdbool.h>
#include <sys/stat.h>

typedef struct Place {
    int folder;       // handle (O_PATH) of the deepest existing folder; -1 if none
    char *missing;    // missing folders below it, "a/b/"; "" if none; owned
    char *name;       // last part of the path; owned
    bool exists;      // set by place_look: the file exists, and `file` describes it
    bool is_link;     // set by place_look without `follow`: the name is a link
    bool is_alias;    // set by place_look: the name stands for an open file, as /dev/stdout does
    struct stat file; // of a link that was not followed: the link itself
    char *made;       // set by place_make: the folders that it made, "a/b/"; owned
} Place;

// Resolves the folder of `path`, but not its last part. ".." after a missing folder leads to where
// that folder's parent would be. ENOTDIR, EACCES, ENOMEM, ...
int place_find(Place *place, const char *path);

// Looks whether the file exists. `follow`: for a link, moves to the place of its target, which need
// not exist. EISDIR: the name cannot be a file ("", "..", a slash at its end); ENAMETOOLONG, ELOOP,
// ...
int place_look(Place *place, bool follow);

// Makes the missing folders. `mode`: their permissions before the umask.
int place_make(Place *place, mode_t mode);

// Keeps other processes from removing the folder (place_unmake) until the place and its copies are
// closed. The folder may just have been removed: then nothing can be created in it (ENOENT). Does
// nothing where folders cannot be read or locked.
void place_hold(Place *place);

// Removes the folders that place_make made, if they are empty and no other process holds them.
void place_unmake(Place *place);

// Whether the folder is `home` or below it.
bool place_is_within(const Place *place, const struct stat *home);

// A copy with its own handle and another name.
int place_copy(Place *copy, const Place *place, const char *name);

// Accepts a place that could not be found.
void place_close(Place *place);

// Whether both describe the same file.
bool place_is_same(const struct stat *a, const struct stat *b);
