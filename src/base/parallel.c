// SPDX-License-Identifier: MIT
#include "base/parallel.h"

#include <assert.h>
#include <pthread.h>
#include <stdbool.h>
#include <unistd.h>

typedef struct Share {
    void (*work)(void *data, int part);
    void *data;
    int part;
    pthread_t thread;
    bool running;
} Share;

static pthread_once_t counted = PTHREAD_ONCE_INIT;
static int threads;

static void count_threads(void)
{
    long count = sysconf(_SC_NPROCESSORS_ONLN);
    threads = count < 1 ? 1 : count > PARALLEL_MOST ? PARALLEL_MOST : (int)count;
}

int parallel_threads(void)
{
    pthread_once(&counted, count_threads);
    return threads;
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
        shares[i].running = pthread_create(&shares[i].thread, NULL, run, &shares[i]) == 0;
    }
    work(data, 0);
    for (int i = 1; i < parts; ++i) {
        if (shares[i].running)
            pthread_join(shares[i].thread, NULL);
        else
            work(data, i);
    }
}
