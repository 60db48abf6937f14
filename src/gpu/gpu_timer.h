// SPDX-License-Identifier: MIT
// Times of GPU work by label: from GL timer queries; on a CPU driver, whose queries do not see
// compute shaders (llvmpipe 22.3), from the clock with the driver idle before and after.
#pragma once

#include "base/error.h"

#include <epoxy/gl.h>
#include <stdbool.h>

enum { TIMER_MAX_LABELS = 16, TIMER_RING = 4 };

// What one label has cost so far. A span that is measured while an earlier one has no result yet
// waits for nothing.
typedef struct TimerLabel {
    const char *name; // not owned: a string constant, the same word as in statistics and benchmarks
    GLuint query[TIMER_RING];
    unsigned begun, read; // spans begun and spans whose result was read
    double total_ms;
} TimerLabel;

typedef struct GpuTimer {
    bool enabled;  // off: begin and end cost nothing
    bool by_clock; // a CPU driver
    double begun_ms;
    TimerLabel labels[TIMER_MAX_LABELS];
    int count;
    int current;      // label that is being measured, -1: none
    const char *pass; // that has begun, measured or not
} GpuTimer;

// `enabled` is false where nobody asks for times; `software` as Gpu has it.
void gpu_timer_create(GpuTimer *timer, bool enabled, bool software);
void gpu_timer_destroy(GpuTimer *timer);

// Measures the GL commands between begin and end under `name`, to which their errors are put down
// (gpu_error.h) also where nobody measures. Spans do not nest.
void gpu_timer_begin(GpuTimer *timer, const char *name);
void gpu_timer_end(GpuTimer *timer);

// Adds up what has been measured; waits until it is there.
void gpu_timer_collect(GpuTimer *timer);
