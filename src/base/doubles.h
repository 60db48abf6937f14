// SPDX-License-Identifier: MIT
// Lists of numbers in double precision.
#pragma once

#include <stddef.h>

// Rising. NaN is not among them.
void doubles_sort(double *values, size_t count);
