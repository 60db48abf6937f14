// SPDX-License-Identifier: MIT
// Lists of numbers in double precision.
#pragma once

#include <stddef.h>

// Sorts in ascending order. The values must not contain NaN.
void doubles_sort(double *values, size_t count);
