// SPDX-License-Identifier: MIT
#include "base/doubles.h"

#include <stdlib.h>

static int compare(const void *a, const void *b)
{
    double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

void doubles_sort(double *values, size_t count)
{
    if (count) qsort(values, count, sizeof *values, compare);
}
