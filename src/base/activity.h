// SPDX-License-Identifier: MIT
// Shows what a program is doing on one line of a terminal. A thread draws it when reading,
// uploading or drawing takes longer than a second, so that the terminal does not look dead. One
// line per process.
#pragma once

#include <stdbool.h>
#include <stdio.h>

// Columns of a terminal, at most 200; 80 if unknown.
int activity_width(FILE *stream);

// Shows the line on `stream` (stderr) from now on. Not if `quiet`, if the stream is not a terminal,
// or if no thread can be started; then all other functions do nothing.
void activity_start(FILE *stream, bool quiet);

// Sets the current activity ("reading hair.tfx"; at most 100 characters are kept); NULL: nothing
// that takes long. Seconds count from this call. Thread-safe.
void activity_set(const char *what);

// Draws a line that precedes the activity until it is replaced (base/progress.h). NULL erases the
// line, so that a message can be printed in its place. False if nothing is shown on this stream;
// then the caller draws the line itself.
bool activity_line(FILE *stream, const char *line);

// Columns to reserve for the activity on a stream that shows it, otherwise 0.
int activity_columns(FILE *stream);

// Erases the line and ends the thread.
void activity_end(void);
