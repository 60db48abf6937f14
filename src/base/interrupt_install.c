// SPDX-License-Identifier: MIT
#include "base/interrupt_install.h"

#include "base/error.h"
#include "base/interrupt.h"
#include "base/leftovers.h"
#include "base/parallel.h"

#include <errno.h>
#include <pthread.h>
#include <semaphore.h>
#include <signal.h>
#include <stdio.h>
#include <time.h>
#include <unistd.h>

// Time for the program to notice the request, and then to end: it may have to write the state of a
// large simulation.
enum { NOTICE_MS = 300, END_MS = 20000 };

static int signals[] = {SIGINT, SIGTERM, SIGHUP}; // 0 if left as it was
enum { SIGNAL_COUNT = sizeof signals / sizeof *signals };

static sem_t request_came;

static void request(int number)
{
    (void)number;
    interrupt_request();
    for (int i = 0; i < SIGNAL_COUNT; ++i)
        if (signals[i]) signal(signals[i], SIG_DFL);
    sem_post(&request_came);
}

static void wait_ms(int ms)
{
    struct timespec left = {.tv_sec = ms / 1000, .tv_nsec = ms % 1000 * 1000000L};
    while (nanosleep(&left, &left) != 0 && errno == EINTR) {
    }
}

// Waits for a signal, then ends the program if it does not react in time, for instance because it
// is inside a library.
static void *watch(void *unused)
{
    (void)unused;
    while (sem_wait(&request_came) != 0 && errno == EINTR) {
    }
    wait_ms(NOTICE_MS);
    if (interrupt_noticed()) wait_ms(END_MS);
    leftovers_remove();
    dprintf(STDERR_FILENO, "%s: interrupted\n", program_invocation_short_name);
    _exit(RESULT_INTERRUPTED);
}

// Starts the watching thread. If that fails, only loops that test the flag can be interrupted.
static void start_watch(void)
{
    pthread_t thread;
    interrupt_expect();
    sem_init(&request_came, 0, 0);
    if (parallel_start(&thread, watch, NULL) == 0) pthread_detach(thread);
}

void interrupt_install(void)
{
    // SA_RESTART: a signal must not make a write to a file fail.
    struct sigaction action = {.sa_handler = request, .sa_flags = SA_RESTART}, old;
    sigemptyset(&action.sa_mask);
    start_watch();
    // nohup sets SIGHUP to be ignored; keep that.
    if (sigaction(SIGHUP, NULL, &old) == 0 && old.sa_handler == SIG_IGN) signals[2] = 0;
    for (int i = 0; i < SIGNAL_COUNT; ++i)
        if (signals[i]) sigaction(signals[i], &action, NULL);
    signal(SIGPIPE, SIG_IGN);
    signal(SIGXFSZ, SIG_IGN);
}
