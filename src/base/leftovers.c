// SPDX-License-Identifier: MIT
#include "base/leftovers.h"

#include <dirent.h>
#include <errno.h>
#include <fcntl.h>
#include <pthread.h>
#include <signal.h>
#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#define NAME_FORMAT ".tractrix-%08x-%ld-%u.tmp"

struct Leftover {
    Leftover *next;
    int group;  // process group; 0 if this is a file
    int folder; // folder that holds the file
    char name[];
};

static pthread_mutex_t lock = PTHREAD_MUTEX_INITIALIZER;
static Leftover *first;
static struct stat swept; // the folder that was swept last

static Leftover *add(int folder, const char *name, int group)
{
    size_t size = strlen(name) + 1;
    Leftover *leftover = malloc(sizeof *leftover + size);
    if (!leftover) return NULL;
    leftover->group = group;
    leftover->folder = folder;
    memcpy(leftover->name, name, size);
    pthread_mutex_lock(&lock);
    leftover->next = first;
    first = leftover;
    pthread_mutex_unlock(&lock);
    return leftover;
}

Leftover *leftover_add_file(int folder, const char *name)
{
    return add(folder, name, 0);
}

Leftover *leftover_add_group(int process_group)
{
    return add(-1, "", process_group);
}

void leftover_forget(Leftover *leftover)
{
    if (!leftover) return;
    pthread_mutex_lock(&lock);
    Leftover **link = &first;
    while (*link && *link != leftover) link = &(*link)->next;
    if (*link) *link = leftover->next;
    pthread_mutex_unlock(&lock);
    free(leftover);
}

void leftovers_remove(void)
{
    pthread_mutex_lock(&lock); // not unlocked again, so that nothing can be added any more
    for (const Leftover *leftover = first; leftover; leftover = leftover->next) {
        if (leftover->group)
            kill(-leftover->group, SIGKILL);
        else
            unlinkat(leftover->folder, leftover->name, 0);
    }
}

// --- Leftovers of other runs.

// FNV-1a hash of the machine's name, because process numbers are only valid on their machine.
static uint32_t hash_host(void)
{
    char host[256] = "";
    uint32_t hash = 2166136261u;
    gethostname(host, sizeof host - 1);
    for (const char *at = host; *at; ++at) hash = (hash ^ (uint8_t)*at) * 16777619u;
    return hash;
}

void leftovers_name(char name[LEFTOVER_NAME_SIZE], unsigned number)
{
    snprintf(name, LEFTOVER_NAME_SIZE, NAME_FORMAT, hash_host(), (long)getpid(), number);
}

// Whether the process has ended but its parent has not asked for its status: for ever in a
// container whose first process does not do so. False if the state cannot be read.
static bool is_zombie(long process)
{
    char path[48], state = 0;
    snprintf(path, sizeof path, "/proc/%ld/stat", process);
    FILE *stream = fopen(path, "re");
    if (!stream) return false;
    // The state follows the program's name, which stands in brackets and may hold brackets itself.
    for (int c; (c = getc(stream)) != EOF;)
        if (c == ')' && getc(stream) == ' ') state = (char)getc(stream);
    fclose(stream);
    return state == 'Z';
}

static bool has_ended(long process)
{
    return kill((pid_t)process, 0) != 0 ? errno == ESRCH : is_zombie(process);
}

// Whether this is the name of a temporary file from this machine whose process has ended.
static bool is_abandoned(const char *name)
{
    unsigned host, number;
    long process;
    char same[LEFTOVER_NAME_SIZE];
    if (sscanf(name, NAME_FORMAT, &host, &process, &number) != 3 || process <= 0) return false;
    snprintf(same, sizeof same, NAME_FORMAT, host, process, number);
    return strcmp(name, same) == 0 && host == hash_host() && has_ended(process);
}

// A container that shares the folder has process numbers of its own. Files in use are locked, so
// only unlocked ones are removed.
static void remove_unlocked(int folder, const char *name)
{
    int file = openat(folder, name, O_RDONLY | O_NOFOLLOW | O_CLOEXEC | O_NONBLOCK);
    if (file < 0) return;
    if (flock(file, LOCK_EX | LOCK_NB) == 0) unlinkat(folder, name, 0);
    close(file);
}

static void sweep(int folder)
{
    int readable = openat(folder, ".", O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    DIR *directory = readable < 0 ? NULL : fdopendir(readable);
    if (!directory) {
        if (readable >= 0) close(readable);
        return;
    }
    for (const struct dirent *entry; (entry = readdir(directory));)
        if (is_abandoned(entry->d_name)) remove_unlocked(folder, entry->d_name);
    closedir(directory);
}

void leftovers_sweep(int folder)
{
    struct stat now;
    if (fstat(folder, &now) != 0) return;
    pthread_mutex_lock(&lock);
    bool again = swept.st_dev == now.st_dev && swept.st_ino == now.st_ino;
    swept = now;
    pthread_mutex_unlock(&lock);
    if (!again) sweep(folder);
}
