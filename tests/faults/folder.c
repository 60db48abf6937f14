// SPDX-License-Identifier: MIT
#include "faults/folder.h"

#include <dirent.h>
#include <errno.h>
#include <ftw.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

static void end(const char *path, const char *what)
{
    fprintf(stderr, "torture: %s: %s: %s\n", path, what, strerror(errno));
    exit(1);
}

static void read_one(FolderFile *file, const char *folder, const char *name)
{
    char path[4200];
    struct stat status;
    snprintf(path, sizeof path, "%s/%s", folder, name);
    snprintf(file->name, sizeof file->name, "%s", name);
    FILE *stream = fopen(path, "rb");
    if (!stream || fstat(fileno(stream), &status) != 0) {
        end(path, "cannot read");
        return;
    }
    file->size = (size_t)status.st_size;
    file->bytes = malloc(file->size + 1);
    if (!file->bytes || fread(file->bytes, 1, file->size, stream) != file->size)
        end(path, "cannot read");
    fclose(stream);
}

void folder_read(Folder *folder, const char *path)
{
    *folder = (Folder){.count = 0};
    DIR *directory = opendir(path);
    if (!directory) {
        end(path, "cannot open");
        return;
    }
    for (const struct dirent *entry; (entry = readdir(directory));) {
        if (strcmp(entry->d_name, ".") == 0 || strcmp(entry->d_name, "..") == 0) continue;
        if (folder->count == FOLDER_FILES) end(path, "too many files");
        read_one(&folder->files[folder->count++], path, entry->d_name);
    }
    closedir(directory);
}

void folder_destroy(Folder *folder)
{
    for (int i = 0; i < folder->count; ++i) free(folder->files[i].bytes);
    folder->count = 0;
}

const FolderFile *folder_find(const Folder *folder, const char *name)
{
    for (int i = 0; i < folder->count; ++i)
        if (strcmp(folder->files[i].name, name) == 0) return &folder->files[i];
    return NULL;
}

bool folder_same(const FolderFile *a, const FolderFile *b)
{
    return a->size == b->size && memcmp(a->bytes, b->bytes, a->size) == 0;
}

static int remove_one(const char *path, const struct stat *status, int kind, struct FTW *at)
{
    (void)status, (void)kind, (void)at;
    return remove(path);
}

void folder_remove(const char *path)
{
    nftw(path, remove_one, 16, FTW_DEPTH | FTW_PHYS);
}

void folder_clear(const char *path)
{
    folder_remove(path);
    if (mkdir(path, 0777) != 0) end(path, "cannot make it");
}
