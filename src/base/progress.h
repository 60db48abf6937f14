// SPDX-License-Identifier: MIT
// The progress bar: one line on a terminal that is drawn over and over, nothing anywhere else.
#pragma once

#include <stdbool.h>
#include <stddef.h>
#include <stdio.h>

typedef struct Progress {
    FILE *stream;     // NULL: silent
    int total;        // frames to do
    int done;         // frames done when `rate` was last brought up to date
    double rate;      // frames a second, smoothed
    double updated_s; // when `done` was counted
    double drawn_s;   // when the line was last drawn
    int shown;        // characters now on the line, 0: clear
} Progress;

// Starts at 0 of `total` (> 0) frames. Silent for ever if `quiet` or if `stream` (stderr) is not a
// terminal. Nothing is drawn yet and nothing needs to be freed. A zeroed Progress is silent.
void progress_start(Progress *progress, FILE *stream, int total, bool quiet);

// `done` frames are done. Draws at most ten times a second, and always the last frame.
void progress_update(Progress *progress, int done);

// The same with the time given (seconds on any steady clock, also to be used for
// progress_start_at).
void progress_start_at(Progress *progress, FILE *stream, int total, bool quiet, double now_s);
void progress_update_at(Progress *progress, int done, double now_s);

// Erases the line so that a message can be printed in its place; the next update draws it again.
// Also the way to end.
void progress_clear(Progress *progress);

// The line for `columns` (at least 40 are assumed) as text of at most columns - 1 characters:
// count, bar, rate in frames a second, remaining time; rate and time only if `rate` > 0. Returns
// its length. `size` is the buffer's.
int progress_format(char *line, size_t size, int columns, int done, int total, double rate);
