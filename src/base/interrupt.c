// SPDX-License-Identifier: MIT
#include "base/interrupt.h"

#include <signal.h>
#include <stdatomic.h>
#include <stddef.h>

// Lock-free, so both a signal handler and any thread may touch it.
static atomic_bool requested;

static void request(int number)
{
    (void)number;
    atomic_store(&requested, true);
    signal(SIGINT, SIG_DFL);
    signal(SIGTERM, SIG_DFL);
}

void interrupt_install(void)
{
    // Writes to files must not stop half way for the signal's sake, hence SA_RESTART.
    struct sigaction action = {.sa_handler = request, .sa_flags = SA_RESTART};
    sigemptyset(&action.sa_mask);
    sigaction(SIGINT, &action, NULL);
    sigaction(SIGTERM, &action, NULL);
    signal(SIGPIPE, SIG_IGN);
    signal(SIGXFSZ, SIG_IGN);
}

bool interrupt_requested(void)
{
    return atomic_load(&requested);
}
