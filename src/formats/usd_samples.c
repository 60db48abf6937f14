// SPDX-License-Identifier: MIT
#include "formats/usd_samples.h"

#include <math.h>
#include <stdlib.h>

static bool add_sample(UsdSamples *samples, Reader *reader, double time)
{
    UsdValues values = {.time = time};
    UsdValues *more = reader_realloc(reader, samples->sample, (samples->count + 1), sizeof *more);
    if (!more) return reader_fail_memory(reader) == RESULT_OK;
    samples->sample = more;
    usd_text_read_values(reader, &values);
    samples->sample[samples->count++] = values;
    return true;
}

static void drop(UsdSamples *samples)
{
    for (size_t i = 0; i < samples->count; ++i) free(samples->sample[i].value);
    samples->count = samples->in_file = 0;
}

void usd_samples_read(UsdSamples *samples, Reader *reader, bool timed, bool all)
{
    double time, last = -INFINITY;
    if (samples->timed && !timed) {
        usd_text_skip_value(reader);
        return;
    }
    drop(samples);
    samples->timed = timed;
    if (!timed) {
        add_sample(samples, reader, 0);
        return;
    }
    usd_text_expect(reader, '{');
    for (; usd_text_next_sample(reader, &time); ++samples->in_file) {
        if (time <= last)
            reader_fail(reader, "time sample %g: expected a time after that of the previous sample",
                        time);
        last = time;
        // Of several samples a frame, as for motion blur, a whole one is the first frame.
        bool better = samples->count == 1 && time == floor(time) &&
                      time < samples->sample[0].time + 1 &&
                      samples->sample[0].time != floor(samples->sample[0].time);
        if (!all && better) {
            free(samples->sample[0].value);
            samples->count = 0;
        }
        if (samples->count > 0 && !all)
            usd_text_skip_value(reader);
        else if (!add_sample(samples, reader, time))
            return;
    }
}

void usd_samples_destroy(UsdSamples *samples)
{
    drop(samples);
    free(samples->sample);
    *samples = (UsdSamples){0};
}

double usd_samples_find(const UsdSamples *samples, double time, const float **a, const float **b)
{
    const UsdValues *sample = samples->sample;
    size_t next = 0, last = samples->timed ? samples->count - 1 : 0;
    while (next < last) { // the first one that is not earlier
        size_t middle = next + (last - next) / 2;
        if (sample[middle].time < time)
            next = middle + 1;
        else
            last = middle;
    }
    size_t before = next > 0 && sample[next].time > time ? next - 1 : next;
    *a = sample[before].value;
    *b = sample[next].value;
    return before == next
               ? 0
               : (time - sample[before].time) / (sample[next].time - sample[before].time);
}
