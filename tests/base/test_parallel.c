// SPDX-License-Identifier: MIT
// parallel_run: every part is done once, whatever else uses the threads.
#include "base/parallel.h"

#include <setjmp.h>
#include <signal.h>
#include <stdarg.h>
#include <stdatomic.h>
#include <stdbool.h>
#include <stddef.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

#include <cmocka.h>

enum { MOST_PARTS = 40, CALLERS = 3, CALLS = 400 };

static void wait_ms(long ms)
{
    nanosleep(&(struct timespec){.tv_nsec = ms * 1000000}, NULL);
}

typedef struct Counts {
    atomic_int of_part[MOST_PARTS];
} Counts;

static void count_part(void *data, int part)
{
    Counts *counts = data;
    atomic_fetch_add(&counts->of_part[part], 1);
}

// Whether each of `parts` parts is done once and no other.
static bool runs_each_once(int parts)
{
    Counts counts = {0};
    bool good = true;
    parallel_run(parts, count_part, &counts);
    for (int i = 0; i < MOST_PARTS; ++i) good = good && counts.of_part[i] == (i < parts);
    return good;
}

static void every_part_is_done_once(void **state)
{
    (void)state;
    for (int threads = 0; threads <= PARALLEL_MOST; ++threads) {
        parallel_set_threads(threads);
        for (int parts = 1; parts <= MOST_PARTS; ++parts)
            if (!runs_each_once(parts)) fail_msg("%d parts on %d threads", parts, threads);
    }
}

// --- Side by side.

typedef struct Meeting {
    pthread_t caller;
    atomic_bool came;
    bool blocks_signals;
} Meeting;

// The calling thread's part waits (a minute at most) until another thread does the other part.
static void meet(void *data, int part)
{
    Meeting *meeting = data;
    sigset_t blocked;
    if (part == 0) {
        for (int i = 0; i < 6000 && !meeting->came; ++i) wait_ms(10);
    } else if (!pthread_equal(pthread_self(), meeting->caller)) {
        pthread_sigmask(SIG_SETMASK, NULL, &blocked);
        meeting->blocks_signals = sigismember(&blocked, SIGTERM) && sigismember(&blocked, SIGPIPE);
        meeting->came = true;
    }
}

static void parts_are_done_side_by_side(void **state)
{
    (void)state;
    parallel_set_threads(2);
    for (int i = 0; i < 3; ++i) {
        Meeting meeting = {.caller = pthread_self()};
        parallel_run(2, meet, &meeting);
        assert_true(meeting.came);
        assert_true(meeting.blocks_signals);
        if (i == 1) parallel_end(); // the next call starts threads again
    }
}

static void run_inside(void *data, int part)
{
    (void)part;
    if (!runs_each_once(5)) atomic_store((atomic_bool *)data, true);
}

static void *call_often(void *data)
{
    for (int i = 0; i < CALLS; ++i) parallel_run(1 + i % 5, run_inside, data);
    return NULL;
}

static void threads_may_call_at_the_same_time(void **state)
{
    pthread_t threads[CALLERS];
    atomic_bool failed = false;
    (void)state;
    parallel_set_threads(3);
    for (int i = 0; i < CALLERS; ++i)
        assert_int_equal(pthread_create(&threads[i], NULL, call_often, &failed), 0);
    for (int i = 0; i < 20; ++i) { // ending threads meanwhile takes nothing from a call
        wait_ms(1);
        parallel_end();
    }
    for (int i = 0; i < CALLERS; ++i) pthread_join(threads[i], NULL);
    assert_false(failed);
}

// --- Processes.

static void *call_until_told(void *data)
{
    while (!atomic_load((atomic_bool *)data)) runs_each_once(3);
    return NULL;
}

// A fork while another thread calls: the child has no other threads, and starts its own.
static void a_forked_child_starts_its_own_threads(void **state)
{
    atomic_bool enough = false;
    pthread_t other;
    (void)state;
#ifdef __SANITIZE_THREAD__
    skip(); // ThreadSanitizer cannot follow threads that a forked child starts
#endif
    parallel_set_threads(4);
    assert_int_equal(pthread_create(&other, NULL, call_until_told, &enough), 0);
    for (int i = 0; i < 20; ++i) {
        pid_t child = fork();
        if (child == 0) {
            Meeting meeting = {.caller = pthread_self()};
            alarm(60); // ends a child that hangs
            parallel_run(2, meet, &meeting);
            bool good = meeting.came && runs_each_once(9);
            parallel_end();
            _exit(good ? 0 : 1);
        }
        int status = 1;
        assert_true(child > 0 && waitpid(child, &status, 0) == child);
        assert_int_equal(status, 0);
        if (!runs_each_once(7)) fail_msg("fork %d: the parent lost a part", i);
    }
    atomic_store(&enough, true);
    pthread_join(other, NULL);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_part_is_done_once),
        cmocka_unit_test(parts_are_done_side_by_side),
        cmocka_unit_test(threads_may_call_at_the_same_time),
        cmocka_unit_test(a_forked_child_starts_its_own_threads),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
