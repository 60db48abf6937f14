// SPDX-License-Identifier: MIT
#include "base/parallel.h"

#include <assert.h>
#include <sched.h>
#include <signal.h>
#include <stdatomic.h>
#include <stdbool.h>
#include <unistd.h>

typedef struct Share {
    void (*work)(void *data, int part);
    void *data;
    int part;
    pthread_t thread;
    bool running;
} Share;

static atomic_int threads; // 0 if not counted yet

static int count_processors(void)
{
    cpu_set_t allowed;
    long count = sched_getaffinity(0, sizeof allowed, &allowed) == 0
                     ? CPU_COUNT(&allowed)
                     : sysconf(_SC_NPROCESSORS_ONLN);
    return count < 1 ? 1 : count > PARALLEL_MOST ? PARALLEL_MOST : (int)count;
}

int parallel_threads(void)
{
    int count = atomic_load(&threads);
    if (count) return count;
    count = count_processors();
    atomic_store(&threads, count);
    return count;
}

void parallel_set_threads(int count)
{
    atomic_store(&threads, count > PARALLEL_MOST ? PARALLEL_MOST : count < 0 ? 0 : count);
}

int parallel_start(pthread_t *thread, void *(*work)(void *data), void *data)
{
    sigset_t all, before;
    sigfillset(&all);
    pthread_sigmask(SIG_SETMASK, &all, &before);
    int reason = pthread_create(thread, NULL, work, data);
    pthread_sigmask(SIG_SETMASK, &before, NULL);
    return reason;
}

static void *run(void *argument)
{
    const Share *share = argument;
    share->work(share->data, share->part);
    return NULL;
}

void parallel_run(int parts, void (*work)(void *data, int part), void *data)
{
    Share shares[PARALLEL_MOST];
    assert(parts <= PARALLEL_MOST);
    for (int i = 1; i < parts; ++i) {
        shares[i] = (Share){.work = work, .data = data, .part = i};
        shares[i].running = parallel_start(&shares[i].thread, run, &shares[i]) == 0;
    }
    work(data, 0);
    for (int i = 1; i < parts; ++i) {
        if (shares[i].running)
            pthread_join(shares[i].thread, NULL);
        else
            work(data, i);
    }
}
