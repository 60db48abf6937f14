// SPDX-License-Identifier: MIT
// Work that the program's own threads share.
#pragma once

#include <pthread.h>

enum { PARALLEL_MOST = 16 };

// How many threads are worth having: the processors that the process may use, at most
// PARALLEL_MOST; or what parallel_set_threads has said (0: nothing).
int parallel_threads(void);
void parallel_set_threads(int count);

// Starts a thread that signals go past, since they are the main thread's: with SIGPIPE and SIGXFSZ
// blocked a write that fails says so by its result. Returns what pthread_create does.
int parallel_start(pthread_t *thread, void *(*work)(void *data), void *data);

// Calls work(data, part) for part = 0 .. parts - 1 (at most PARALLEL_MOST), each on a thread of its
// own as far as there are threads, and returns when all are done.
void parallel_run(int parts, void (*work)(void *data, int part), void *data);
