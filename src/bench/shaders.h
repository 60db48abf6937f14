// SPDX-License-Identifier: MIT
// Compiles every shader variant that the program can ask for, with warnings as errors.
#pragma once

#include "gpu/gpu.h"

// Prints a line a program on `stream`; RESULT_FAILED with the first message if any does not compile
// cleanly (all are tried).
Result shaders_check(const Gpu *gpu, FILE *stream, Error *error);
