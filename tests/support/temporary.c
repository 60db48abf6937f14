// SPDX-License-Identifier: MIT
#include "support/temporary.h"

#include <dirent.h>
#include <ftw.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

int temporary_create(void **state)
{
    const char *parent = getenv("TMPDIR");
    Temporary *temporary = calloc(1, sizeof *temporary);
    if (!temporary) return -1;
    snprintf(temporary->folder, sizeof temporary->folder, "%s/tractrix-test-XXXXXX",
             parent ? parent : "/tmp");
    *state = temporary;
    return mkdtemp(temporary->folder) ? 0 : -1;
}

static int remove_entry(const char *path, const struct stat *status, int kind, struct FTW *place)
{
    (void)status, (void)kind, (void)place;
    return remove(path);
}

int temporary_destroy(void **state)
{
    Temporary *temporary = *state;
    int failed = nftw(temporary->folder, remove_entry, 16, FTW_DEPTH | FTW_PHYS);
    free(temporary);
    return failed;
}

const char *temporary_path(void **state, const char *name)
{
    static char paths[8][512];
    static int next;
    const Temporary *temporary = *state;
    char *path = paths[next++ % 8];
    snprintf(path, sizeof paths[0], "%s/%s", temporary->folder, name);
    return path;
}

int temporary_count_files(const char *path)
{
    DIR *folder = opendir(path);
    if (!folder) return -1;
    int count = 0;
    for (const struct dirent *entry = readdir(folder); entry; entry = readdir(folder))
        count += strcmp(entry->d_name, ".") != 0 && strcmp(entry->d_name, "..") != 0;
    closedir(folder);
    return count;
}

bool temporary_has(void **state, const char *name)
{
    return access(temporary_path(state, name), F_OK) == 0;
}

void temporary_write(void **state, const char *name, const char *text, unsigned mode)
{
    const char *path = temporary_path(state, name);
    FILE *file = fopen(path, "wb");
    if (!file) abort();
    fputs(text, file);
    if (fclose(file) != 0 || chmod(path, mode) != 0) abort();
}
