// SPDX-License-Identifier: MIT
// The times at which prims of a USD layer are evaluated.
#pragma once

#include "base/reader.h"

// In time codes. A zeroed struct is empty.
typedef struct UsdTimes {
    double *time; // [count]
    uint32_t count, room;
    int first;   // number of the first frame
    double step; // time codes per frame
    bool evened; // uneven times were replaced by whole time codes
} UsdTimes;

void usd_times_add(UsdTimes *times, Reader *reader, double time);

// Sorts the times and removes duplicates.
void usd_times_sort(UsdTimes *times);

// For at least two ascending times. Unevenly spaced times, and those less than one time code apart,
// are replaced by all whole time codes from the first to the last.
void usd_times_even_out(UsdTimes *times, Reader *reader);
void usd_times_destroy(UsdTimes *times);
