// SPDX-License-Identifier: MIT
// The times at which the prims of a USD layer are looked at.
#pragma once

#include "base/reader.h"

// In time codes. Zeroed, there are none.
typedef struct UsdTimes {
    double *time; // [count]
    uint32_t count, room;
    int first;   // number of the first frame
    double step; // time codes from frame to frame
    bool evened; // times were uneven, and are whole time codes now
} UsdTimes;

void usd_times_add(UsdTimes *times, Reader *reader, double time);

// Makes them rise, each there once.
void usd_times_sort(UsdTimes *times);

// Of at least two that rise. Times that are not evenly spaced become all whole time codes between
// the first and the last.
void usd_times_even_out(UsdTimes *times, Reader *reader);
void usd_times_destroy(UsdTimes *times);
