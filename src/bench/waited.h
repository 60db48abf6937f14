// SPDX-License-Identifier: MIT
// Whether others kept this process from its processors while a time was taken.
#pragma once

// Times of all threads of this process that live, ms: running, and ready but without a processor.
typedef struct Waited {
    double ran, waited;
} Waited;

// Now; zeros where the system does not tell (/proc/self/task/*/schedstat).
Waited waited_now(void);

// The share of its time since `before` that the process waited for a processor, 0..1; 0 where the
// system does not tell.
double waited_since(Waited before);

// A time that was taken while the share was greater says nothing about a bound.
#define WAITED_MOST 0.05
