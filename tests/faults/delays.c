// SPDX-License-Identifier: MIT
// Loaded into every program by LD_PRELOAD (make delays): calls that read, write, rename, remove or
// start a thread wait for a random time, as on a slow disk or a busy machine. What programs do may
// not depend on how fast this is, and neither may tests.
#include <dlfcn.h>
#include <errno.h>
#include <pthread.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>
#include <unistd.h>

// Waits up to most_ms in one of `share` cases.
static void wait_at_random(uint32_t share, uint32_t most_ms)
{
    static _Thread_local uint64_t state; // xorshift (Marsaglia 2003)
    int kept = errno;
    struct timespec now;
    clock_gettime(CLOCK_MONOTONIC, &now);
    if (!state) state = (uint64_t)now.tv_nsec * 2654435761u + (uint64_t)(uintptr_t)&state + 1;
    state ^= state << 13;
    state ^= state >> 7;
    state ^= state << 17;
    if (state % share == 0) {
        long ns = (long)((state >> 20) % (most_ms * 1000000ull));
        nanosleep(&(struct timespec){0, ns}, NULL);
    }
    errno = kept;
}

// The function that a program would call without this library. dlsym returns no function pointer.
static void find_next(void *function, const char *name)
{
    void *found = dlsym(RTLD_NEXT, name);
    memcpy(function, &found, sizeof found);
}

#define DELAYED(type, name, parameters, arguments, share, most_ms)                                 \
    type name parameters                                                                           \
    {                                                                                              \
        type(*next) parameters;                                                                    \
        find_next(&next, #name);                                                                   \
        wait_at_random(share, most_ms);                                                            \
        return next arguments;                                                                     \
    }

DELAYED(ssize_t, read, (int file, void *bytes, size_t size), (file, bytes, size), 30, 10)
DELAYED(ssize_t, write, (int file, const void *bytes, size_t size), (file, bytes, size), 20, 20)
DELAYED(int, fsync, (int file), (file), 2, 100)
DELAYED(int, rename, (const char *from, const char *to), (from, to), 2, 200)
DELAYED(int, renameat, (int a, const char *from, int b, const char *to), (a, from, b, to), 2, 200)
DELAYED(int, linkat, (int a, const char *from, int b, const char *to, int flags),
        (a, from, b, to, flags), 2, 100)
DELAYED(int, unlink, (const char *path), (path), 2, 50)
DELAYED(int, unlinkat, (int folder, const char *path, int flags), (folder, path, flags), 2, 50)

typedef struct Start {
    void *(*run)(void *);
    void *data;
} Start;

static void *start_late(void *data)
{
    Start start = *(Start *)data;
    free(data);
    wait_at_random(1, 100);
    return start.run(start.data);
}

// Then the thread, not the caller, is late.
int pthread_create(pthread_t *thread, const pthread_attr_t *attributes, void *(*run)(void *),
                   void *data)
{
    int (*next)(pthread_t *, const pthread_attr_t *, void *(*)(void *), void *);
    find_next(&next, "pthread_create");
    Start *start = malloc(sizeof *start);
    if (!start) return EAGAIN;
    *start = (Start){run, data};
    int reason = next(thread, attributes, start_late, start);
    if (reason) free(start);
    return reason;
}
