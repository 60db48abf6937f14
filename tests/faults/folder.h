// SPDX-License-Identifier: MIT
// Names and bytes of the files in a folder, to compare with another state of it.
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

// Reads all files directly in the folder. Ends the program on failure.
void folder_read(Folder *folder, const char *path);
void folder_destroy(Folder *folder);

// NULL: no file has this name.
const FolderFile *folder_find(const Folder *folder, const char *name);
bool folder_same(const FolderFile *a, const FolderFile *b);

// Empties the folder, or creates it.
void folder_clear(const char *path);
void folder_remove(const char *path);
