// SPDX-License-Identifier: MIT
// The progress bar: one line on a terminal that is redrawn; nothing on other streams.
#pragma once

#include <stdbool.h>
#include <stddef.h>
#include <stdio.h>

typedef struct Progress {
    FILE *stream;     // NULL if silent
    int total;        // frames to do
    int done;         // frames done at the last update of `rate`
    double rate;      // frames per second, smoothed
    double updated_s; // time of the last update of `rate`
    double drawn_s;   // time of the last drawing
    int shown;        // characters now on the line, 0 if it is clear
} Progress;

// Starts at 0 of `total` (> 0) frames. Stays silent if `quiet` or if `stream` (stderr) is not a
// terminal. Draws nothing yet, and nothing needs to be freed. A zeroed Progress is silent.
void progress_start(Progress *progress, FILE *stream, int total, bool quiet);

// Reports that `done` frames are done. Draws at most ten times a second, and always the last frame.
void progress_update(Progress *progress, int done);

// The same with the time given, in seconds on any steady clock (also in progress_start_at).
void progress_start_at(Progress *progress, FILE *stream, int total, bool quiet, double now_s);
void progress_update_at(Progress *progress, int done, double now_s);

// Erases the line, so that a message can be printed in its place; the next update draws it again.
// Also ends the progress.
void progress_clear(Progress *progress);

// The line for `columns` (at least 40 are assumed), of at most columns - 1 characters: count, bar,
// frames per second, remaining time; the latter two only if `rate` > 0. Returns its length. `size`
// is that of the buffer.
int progress_format(char *line, size_t size, int columns, int done, int total, double rate);
