// SPDX-License-Identifier: MIT
// The threads of this process, those of libraries included.
#pragma once

// Counts the threads with `part` in their name, which the kernel cuts to 15 bytes.
int threads_named(const char *part);
