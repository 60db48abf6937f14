// SPDX-License-Identifier: MIT
#include "bench/bench_times.h"

#include <math.h>
#include <stdlib.h>

static int compare(const void *a, const void *b)
{
    double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

BenchTimes bench_times_of(double *samples, int count)
{
    if (count == 0) return (BenchTimes){NAN, NAN, NAN, NAN};
    qsort(samples, (size_t)count, sizeof *samples, compare);
    return (BenchTimes){samples[0], samples[count / 4], samples[count / 2], samples[3 * count / 4]};
}
