// SPDX-License-Identifier: MIT
// Clocks in milliseconds from an arbitrary origin; only differences are meaningful.
#pragma once

#include <time.h>

static inline double clock_read_ms(clockid_t clock)
{
    struct timespec now;
    clock_gettime(clock, &now);
    return 1e3 * (double)now.tv_sec + 1e-6 * (double)now.tv_nsec;
}

// Wall-clock time.
static inline double clock_ms(void)
{
    return clock_read_ms(CLOCK_MONOTONIC);
}

// Processor time of all threads of the process.
static inline double clock_processor_ms(void)
{
    return clock_read_ms(CLOCK_PROCESS_CPUTIME_ID);
}
