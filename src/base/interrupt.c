// SPDX-License-Identifier: MIT
#include "base/interrupt.h"

#include <pthread.h>
#include <stdatomic.h>

// Lock-free atomics, which both a signal handler and any thread may use.
static atomic_bool requested, noticed;
static pthread_t main_thread;

void interrupt_expect(void)
{
    main_thread = pthread_self();
}

void interrupt_request(void)
{
    atomic_store(&requested, true);
}

bool interrupt_requested(void)
{
    bool came = atomic_load(&requested);
    if (came && pthread_equal(pthread_self(), main_thread)) atomic_store(&noticed, true);
    return came;
}

bool interrupt_noticed(void)
{
    return atomic_load(&noticed);
}
