// SPDX-License-Identifier: MIT
// Counts OpenGL calls, for tests and for measuring what a frame costs. From gl_count_start on,
// wrappers stand between the program and the driver; before that there is no overhead.
#pragma once

#include <stdint.h>
#include <stdio.h>

// Counts of what stalls a driver's queue. A read is `late`, and waits for nothing, if a fence after
// the command that wrote the bytes was waited for. Every other read is `blocking`: the program
// waits until the GPU has finished everything that is queued. Mapping a buffer for writing while
// keeping its content blocks, too.
typedef struct GlCounts {
    uint64_t calls;
    uint64_t blocking;
    uint64_t late;
    uint64_t waits; // for fences that had not passed when they were checked
    // Reads of buffers after shaders have run, without
    // glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT) between. A GPU may then return what was there
    // before; a CPU driver does not.
    uint64_t unordered;
} GlCounts;

// Installs the counters, all 0. A context must be current, and stay current while they are
// installed.
void gl_count_start(void);
void gl_count_stop(void);
GlCounts gl_count_get(void);

// Marks the end of a frame; does nothing while not counting. gl_count_print writes the mean of the
// last frames, at most 8, with the calls by name, most frequent first; nothing if fewer than two
// frames have ended.
void gl_count_frame(void);
void gl_count_print(FILE *stream);
