// SPDX-License-Identifier: MIT
// Times of GPU work by label. Measured by GL timer queries; on a CPU driver, whose queries do not
// include compute shaders (llvmpipe 22.3), by the clock, with the driver idle before and after.
#pragma once

#include "base/error.h"

#include <epoxy/gl.h>
#include <stdbool.h>

enum { TIMER_MAX_LABELS = 16, TIMER_RING = 4 };

// The cost of one label so far. Starting a span does not wait for the results of earlier spans.
typedef struct TimerLabel {
    // A string constant, not owned; the same label as in statistics and benchmarks.
    const char *name;
    GLuint query[TIMER_RING];
    unsigned begun, read; // spans begun and spans whose result was read
    double total_ms;
} TimerLabel;

typedef struct GpuTimer {
    bool enabled;  // if off, begin and end cost nothing
    bool by_clock; // for a CPU driver
    double begun_ms;
    TimerLabel labels[TIMER_MAX_LABELS];
    int count;
    int current;      // label being measured, -1 if none
    const char *pass; // begun pass, measured or not
} GpuTimer;

// `enabled`: whether times are wanted; `software`: as in Gpu.
void gpu_timer_create(GpuTimer *timer, bool enabled, bool software);
void gpu_timer_destroy(GpuTimer *timer);

// Measures the GL commands between begin and end under `name`. Their errors are attributed to it
// (gpu_error.h), even if times are not measured. Spans do not nest.
void gpu_timer_begin(GpuTimer *timer, const char *name);
void gpu_timer_end(GpuTimer *timer);

// Adds up the measured times; waits for their results.
void gpu_timer_collect(GpuTimer *timer);
