// SPDX-License-Identifier: MIT
// What a program is at, on one line of a terminal: a thread draws it while the program reads,
// uploads or draws for longer than a second, so that no terminal looks dead. One line a process.
#pragma once

#include <stdbool.h>
#include <stdio.h>

// Columns of a terminal, at most 200; 80 where that is unknown.
int activity_width(FILE *stream);

// From now on the line is shown on `stream` (stderr); not if `quiet`, if the stream is no terminal,
// or if no thread can be had. All other functions do nothing then.
void activity_start(FILE *stream, bool quiet);

// What the program is at ("reading hair.tfx"; at most 100 characters are kept), until it is set
// again; NULL: nothing that takes long. Seconds count from here. Any thread may call it.
void activity_set(const char *what);

// A line that is drawn now and stays in front of what the program is at (base/progress.h); NULL:
// none, and the line is erased, so that a message can be printed in its place. False: nothing is
// shown on this stream, and the caller draws for itself.
bool activity_line(FILE *stream, const char *line);

// Columns to leave free for what the program is at, on a stream that shows it; else 0.
int activity_columns(FILE *stream);

// Erases the line and ends the thread.
void activity_end(void);
