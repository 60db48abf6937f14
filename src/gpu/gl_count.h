// SPDX-License-Identifier: MIT
// Counts OpenGL calls, for tests and for who looks at what a frame costs: wrappers stand between
// the program and the driver from gl_count_start on. Nothing is in the way before.
#pragma once

#include <stdint.h>
#include <stdio.h>

// What a driver's queue suffers from. A read is late, and waits for nothing, if a fence behind the
// command that wrote the bytes has been waited for; every other one makes the program wait until
// the GPU has done all that is queued, while nothing is queued behind it: it is blocking. Maps for
// writing that keep a buffer's content block, too.
typedef struct GlCounts {
    uint64_t calls;
    uint64_t blocking;
    uint64_t late;
    uint64_t waits; // for fences that had not passed when they were looked at
} GlCounts;

// Puts the counters in, all at 0; a current context is there, and stays while they are in.
void gl_count_start(void);
void gl_count_stop(void);
GlCounts gl_count_get(void);

// The end of a frame; nothing while nothing is counted. gl_count_print writes the mean of the last
// frames, 8 at most, with calls by name, most frequent first; nothing if fewer than two have ended.
void gl_count_frame(void);
void gl_count_print(FILE *stream);
