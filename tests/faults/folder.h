// SPDX-License-Identifier: MIT
// What lies in a folder: names and bytes of its files, to compare with another time's.
#pragma once

#include <stdbool.h>
#include <stddef.h>

enum { FOLDER_FILES = 64 };

typedef struct FolderFile {
    char name[64];
    unsigned char *bytes;
    size_t size;
} FolderFile;

typedef struct Folder {
    FolderFile files[FOLDER_FILES];
    int count;
} Folder;

// Reads all files of the folder itself (none of folders in it). Ends the program if it cannot.
void folder_read(Folder *folder, const char *path);
void folder_destroy(Folder *folder);

// NULL: no such file.
const FolderFile *folder_find(const Folder *folder, const char *name);
bool folder_same(const FolderFile *a, const FolderFile *b);

// Removes the folder with all that is in it and makes it anew, empty.
void folder_clear(const char *path);
void folder_remove(const char *path);
