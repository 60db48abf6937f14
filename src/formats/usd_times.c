// SPDX-License-Identifier: MIT
#include "formats/usd_times.h"

#include "base/doubles.h"

#include <math.h>
#include <stdlib.h>

void usd_times_add(UsdTimes *times, Reader *reader, double time)
{
    if (times->count == times->room) {
        uint32_t room = 2 * times->room + 64;
        double *more = reader_realloc(reader, times->time, room, sizeof *more);
        if (!more) {
            reader_fail_memory(reader);
            return;
        }
        times->time = more;
        times->room = room;
    }
    times->time[times->count++] = time;
}

void usd_times_sort(UsdTimes *times)
{
    uint32_t all = times->count;
    times->count = 0;
    doubles_sort(times->time, all);
    for (uint32_t i = 0; i < all; ++i)
        if (i == 0 || times->time[i] > times->time[times->count - 1])
            times->time[times->count++] = times->time[i];
}

void usd_times_even_out(UsdTimes *times, Reader *reader)
{
    double first = times->time[0], last = times->time[times->count - 1];
    double step = (last - first) / (times->count - 1);
    bool even = true;
    for (uint32_t i = 1; i < times->count; ++i)
        even = even && fabs(times->time[i] - times->time[i - 1] - step) <= 1e-6 * step;
    times->step = step;
    bool whole = even && fabs(step - 1) < 1e-9 && first == floor(first);
    times->first = whole && first >= 0 && first < 1e7 ? (int)first : 0;
    double from = ceil(first), count = floor(last) - from + 1;
    bool shutter = even && step < 1 - 1e-6; // several samples a frame, as for motion blur
    if ((even && !shutter) || !(count >= 2 && count <= 1e6)) return;
    times->count = 0;
    for (uint32_t i = 0; i < (uint32_t)count; ++i) usd_times_add(times, reader, from + i);
    times->first = from >= 0 ? (int)from : 0;
    times->step = 1;
    times->evened = !even;
}

void usd_times_destroy(UsdTimes *times)
{
    free(times->time);
    *times = (UsdTimes){0};
}
