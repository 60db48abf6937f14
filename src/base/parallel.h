// SPDX-License-Identifier: MIT
// Work that the program's own threads share.
#pragma once

enum { PARALLEL_MOST = 16 };

// How many threads are worth having: the processors there are, at most PARALLEL_MOST.
int parallel_threads(void);

// Calls work(data, part) for part = 0 .. parts - 1 (at most PARALLEL_MOST), each on a thread of its
// own as far as there are threads, and returns when all are done.
void parallel_run(int parts, void (*work)(void *data, int part), void *data);
