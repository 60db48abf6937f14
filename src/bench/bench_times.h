// SPDX-License-Identifier: MIT
// Repeated times, summed up.
#pragma once

// Of some samples, ms.
typedef struct BenchTimes {
    double minimum, lower_quartile, median, upper_quartile;
} BenchTimes;

// Of `count` samples, which are put in order; NaN for none.
BenchTimes bench_times_of(double *samples, int count);
