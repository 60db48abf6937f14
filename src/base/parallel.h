// SPDX-License-Identifier: MIT
// Runs work on several threads.
#pragma once

#include <pthread.h>

enum { PARALLEL_MOST = 16 };

// The useful number of threads: the processors that the process may use, at most PARALLEL_MOST; or
// the number set by parallel_set_threads (0: not set).
int parallel_threads(void);
void parallel_set_threads(int count);

// Starts a thread that receives no signals, because the main thread handles them. SIGPIPE and
// SIGXFSZ are blocked, too, so that a failed write returns an error. Returns the result of
// pthread_create.
int parallel_start(pthread_t *thread, void *(*work)(void *data), void *data);

// Calls work(data, part) for part = 0 .. parts - 1 (at most PARALLEL_MOST), each on its own thread
// if there are enough, and returns when all are done.
void parallel_run(int parts, void (*work)(void *data, int part), void *data);
