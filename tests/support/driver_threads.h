// SPDX-License-Identifier: MIT
// What a program finds with other numbers of the driver's threads. A process keeps the driver that
// it has once loaded, with its threads: so each number is a run of the test program itself.
#pragma once

#include "gpu/gpu.h"

// Runs this program with `argument` alone, which its main answers with driver_threads_tell, and
// with 0, 1 and 2 threads. Fails the test unless all find the same bytes, and llvmpipe has had so
// many threads.
void assert_driver_threads_do_not_matter(const char *argument);

// Says what such a run has found.
void driver_threads_tell(const Gpu *gpu, const void *bytes, size_t size);
