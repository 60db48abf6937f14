// SPDX-License-Identifier: MIT
// Compares the results of a program with different numbers of driver threads. A process keeps the
// driver that it has loaded, with its threads, so each number needs a new process of the test
// program.
#pragma once

#include "gpu/gpu.h"

// Runs this program with `argument` as the only argument, which its main must answer by
// driver_threads_tell, with 0, 1 and 2 threads. Fails the test unless all results have the same
// bytes and llvmpipe has used these numbers of threads.
void assert_driver_threads_do_not_matter(const char *argument);

// Reports the result of such a run.
void driver_threads_tell(const Gpu *gpu, const void *bytes, size_t size);
