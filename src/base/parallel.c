// SPDX-License-Identifier: MIT
#include "base/parallel.h"

#include "base/c_locale.h"

#include <errno.h>
#include <sched.h>
#include <signal.h>
#include <stdatomic.h>
#include <stdint.h>
#include <stdlib.h>
#include <unistd.h>

static atomic_int useful; // threads; 0 if not counted yet

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
    int count = atomic_load(&useful);
    if (count) return count;
    count = count_processors();
    atomic_store(&useful, count);
    return count;
}

void parallel_set_threads(int count)
{
    atomic_store(&useful, count > PARALLEL_MOST ? PARALLEL_MOST : count < 0 ? 0 : count);
}

typedef struct Start {
    void *(*work)(void *data);
    void *data;
} Start;

static void *begin(void *data)
{
    Start start = *(Start *)data;
    free(data);
    c_locale_enter();
    return start.work(start.data);
}

int parallel_start(pthread_t *thread, void *(*work)(void *data), void *data)
{
    Start *start = malloc(sizeof *start);
    if (!start) return ENOMEM;
    *start = (Start){work, data};
    sigset_t all, before;
    sigfillset(&all);
    pthread_sigmask(SIG_SETMASK, &all, &before);
    int reason = pthread_create(thread, NULL, begin, start);
    pthread_sigmask(SIG_SETMASK, &before, NULL);
    if (reason) free(start);
    return reason;
}

// --- The waiting threads. While the lock is held, lists are changed and threads are started, but
// no part is done.

// A call of parallel_run. It lies on the stack of its caller, who removes it from the list and then
// waits for the threads that have joined.
typedef struct Job {
    void (*work)(void *data, int part);
    void *data;
    int parts;
    atomic_int next;     // the next part to be done
    int wanted, joined;  // threads that may still join; that have joined and not finished
    pthread_cond_t left; // the last joined thread has finished
    struct Job *following;
} Job;

static struct {
    pthread_mutex_t lock;
    pthread_cond_t asked; // a job was added, or threads must end
    Job *jobs;            // that threads may join, the newest first
    pthread_t threads[PARALLEL_MOST - 1];
    int count;
    uintptr_t era; // threads that were started in an earlier one must end
} pool = {.lock = PTHREAD_MUTEX_INITIALIZER, .asked = PTHREAD_COND_INITIALIZER};

static void do_parts(Job *job, int part)
{
    for (; part < job->parts; part = atomic_fetch_add(&job->next, 1)) job->work(job->data, part);
}

static Job *find_job(void)
{
    Job *job = pool.jobs;
    while (job && !job->wanted) job = job->following;
    return job;
}

static void help(Job *job)
{
    --job->wanted;
    ++job->joined;
    pthread_mutex_unlock(&pool.lock);
    do_parts(job, atomic_fetch_add(&job->next, 1));
    pthread_mutex_lock(&pool.lock);
    if (--job->joined == 0) pthread_cond_signal(&job->left);
}

static void *serve(void *data)
{
    uintptr_t era = (uintptr_t)data;
    pthread_mutex_lock(&pool.lock);
    while (era == pool.era) {
        Job *job = find_job();
        if (job)
            help(job);
        else
            pthread_cond_wait(&pool.asked, &pool.lock);
    }
    pthread_mutex_unlock(&pool.lock);
    return NULL;
}

// A forked child has no threads, and no job goes on there.
static void lock(void)
{
    pthread_mutex_lock(&pool.lock);
}

static void unlock(void)
{
    pthread_mutex_unlock(&pool.lock);
}

static void forget_threads(void)
{
    pool.jobs = NULL;
    pool.count = 0;
    pthread_cond_init(&pool.asked, NULL);
    unlock();
}

static void watch_forks(void)
{
    pthread_atfork(lock, unlock, forget_threads);
}

static void add_job(Job *job)
{
    static pthread_once_t watched = PTHREAD_ONCE_INIT;
    const int wanted = job->wanted;
    pthread_once(&watched, watch_forks);
    pthread_mutex_lock(&pool.lock);
    while (pool.count < wanted &&
           parallel_start(&pool.threads[pool.count], serve, (void *)pool.era) == 0)
        ++pool.count;
    job->following = pool.jobs;
    pool.jobs = job;
    pthread_mutex_unlock(&pool.lock);
    for (int i = 0; i < wanted; ++i) pthread_cond_signal(&pool.asked);
}

static void remove_job(Job *job)
{
    pthread_mutex_lock(&pool.lock);
    Job **at = &pool.jobs;
    while (*at != job) at = &(*at)->following;
    *at = job->following;
    while (job->joined) pthread_cond_wait(&job->left, &pool.lock);
    pthread_mutex_unlock(&pool.lock);
    pthread_cond_destroy(&job->left);
}

void parallel_run(int parts, void (*work)(void *data, int part), void *data)
{
    int threads = parallel_threads(), most = parts < threads ? parts : threads;
    Job job = {.work = work,
               .data = data,
               .parts = parts,
               .next = 1,
               .wanted = most - 1,
               .left = PTHREAD_COND_INITIALIZER};
    if (most > 1) add_job(&job);
    do_parts(&job, 0);
    if (most > 1) remove_job(&job);
}

__attribute__((destructor)) void parallel_end(void)
{
    pthread_t threads[PARALLEL_MOST - 1];
    pthread_mutex_lock(&pool.lock);
    int count = pool.count;
    for (int i = 0; i < count; ++i) threads[i] = pool.threads[i];
    pool.count = 0;
    ++pool.era;
    pthread_cond_broadcast(&pool.asked);
    pthread_mutex_unlock(&pool.lock);
    for (int i = 0; i < count; ++i) pthread_join(threads[i], NULL);
}
