// SPDX-License-Identifier: MIT
// Runs work on several threads. The threads are started when they are first needed and then wait
// for more work, because starting them anew for each loop costs more. They keep the processors
// (affinity) and priority of the thread that called first.
#pragma once

#include <pthread.h>

enum { PARALLEL_MOST = 16 };

// The useful number of threads: the processors that the process may use, at most PARALLEL_MOST; or
// the number set by parallel_set_threads (0: not set).
int parallel_threads(void);
void parallel_set_threads(int count);

// Starts a thread that receives no signals, because the main thread handles them. SIGPIPE and
// SIGXFSZ are blocked, too, so that a failed write returns an error. The thread has the "C" locale
// (c_locale.h). Returns the result of pthread_create, or ENOMEM.
int parallel_start(pthread_t *thread, void *(*work)(void *data), void *data);

// Calls work(data, part) for part = 0 .. parts - 1, and returns when all are done. The calling
// thread does part 0; other parts are done by up to parallel_threads() - 1 waiting threads, or by
// the calling thread if these are busy. So parts must not wait for each other. Several threads may
// call this at the same time, also from a part.
void parallel_run(int parts, void (*work)(void *data, int part), void *data);

// Ends the waiting threads and returns when they have ended. parallel_run may be called before,
// during and after this call, and starts threads again. Called at exit, too.
void parallel_end(void);
