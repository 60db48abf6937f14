// SPDX-License-Identifier: MIT
// How long this process had to wait for processors while a time was measured.
#pragma once

// Total times of all living threads of this process, ms: running, and ready but without a
// processor.
typedef struct Waited {
    double ran, waited;
} Waited;

// The current times; zeros if the system does not report them (/proc/self/task/*/schedstat).
Waited waited_now(void);

// The share of the time since `before` during which the process waited for a processor, 0..1; 0 if
// the system does not report it.
double waited_since(Waited before);

// If the share was greater, a measured time says nothing about a bound.
#define WAITED_MOST 0.05
