// SPDX-License-Identifier: MIT
#include "base/claims.h"

#include <pthread.h>
#include <search.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

typedef struct Link {
    Claim claim; // first, so that a Claim * can be cast to its Link *
    struct Link *next;
} Link;

// A file that the run has read or written.
typedef struct Known {
    dev_t device;
    ino_t inode;
    bool written;
    char path[];
} Known;

static pthread_mutex_t lock = PTHREAD_MUTEX_INITIALIZER; // protects the tree
static Link *first;
static void *tree; // a search tree of Known

Claim *claims_add(const Claim *claim)
{
    Link *link = calloc(1, sizeof *link), **end = &first;
    if (!link) return NULL;
    link->claim = *claim;
    while (*end) end = &(*end)->next;
    *end = link;
    return &link->claim;
}

Claim *claims_next(const Claim *claim)
{
    Link *link = claim ? ((Link *)claim)->next : first;
    return link ? &link->claim : NULL;
}

static bool has_path(const Claim *claim, const char *path)
{
    size_t length = strlen(claim->before);
    if (strncmp(path, claim->before, length) != 0) return false;
    if (claim->whole_folder) return true;
    if (!claim->after) return !path[length];
    size_t digits = strspn(path + length, "0123456789");
    return digits > 0 && strcmp(path + length + digits, claim->after) == 0;
}

Claim *claims_find(const char *path)
{
    Claim *claim = claims_next(NULL);
    while (claim && !has_path(claim, path)) claim = claims_next(claim);
    return claim;
}

// --- Files.

static int order(const void *a, const void *b)
{
    const Known *x = a, *y = b;
    if (x->device != y->device) return x->device < y->device ? -1 : 1;
    return x->inode == y->inode ? 0 : x->inode < y->inode ? -1 : 1;
}

static void note(const char *path, const struct stat *file, bool written)
{
    Known *known = malloc(sizeof *known + strlen(path) + 1);
    if (!known) return;
    *known = (Known){.device = file->st_dev, .inode = file->st_ino, .written = written};
    strcpy(known->path, path);
    pthread_mutex_lock(&lock);
    Known **found = tsearch(known, &tree, order);
    if (found && *found != known && written) { // the old file is gone and its inode is used again
        free(*found);
        *found = known;
    } else if (!found || *found != known) {
        free(known);
    }
    pthread_mutex_unlock(&lock);
}

void claims_note_input(const char *path, const struct stat *file)
{
    if (first && S_ISREG(file->st_mode) && !claims_find(path)) note(path, file, false);
}

void claims_note_output(const char *path, const struct stat *file)
{
    if (first && S_ISREG(file->st_mode)) note(path, file, true);
}

// Whether the path still leads to the file. If not, the file is gone and another one has its
// inode; other runs may replace what this one has written.
static bool is_current(const Known *known)
{
    struct stat now;
    return stat(known->path, &now) == 0 && now.st_dev == known->device &&
           now.st_ino == known->inode;
}

bool claims_find_other(char other[CLAIMS_PATH_SIZE], bool *written, const char *path,
                       const struct stat *file)
{
    const Known key = {.device = file->st_dev, .inode = file->st_ino};
    pthread_mutex_lock(&lock);
    Known **found = tfind(&key, &tree, order);
    bool another =
        found && !((*found)->written && strcmp((*found)->path, path) == 0) && is_current(*found);
    if (another) {
        snprintf(other, CLAIMS_PATH_SIZE, "%s", (*found)->path);
        *written = (*found)->written;
    }
    pthread_mutex_unlock(&lock);
    return another;
}

void claims_end(void)
{
    // From the last one to the first: a later claim may hold a folder that an earlier one has made.
    while (first) {
        Link **last = &first;
        while ((*last)->next) last = &(*last)->next;
        Claim *claim = &(*last)->claim;
        place_unmake(&claim->place);
        place_close(&claim->place);
        free(claim->before);
        free(claim->after);
        free(*last);
        *last = NULL;
    }
    tdestroy(tree, free);
    tree = NULL;
}
