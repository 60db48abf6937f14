// SPDX-License-Identifier: MIT
// Interpolation between samples at even times: which samples contribute to a time, and with which
// weights.
#pragma once

#include <stdbool.h>
#include <stdint.h>

typedef struct SampleTimes {
    uint32_t count; // >= 1
    double rate;    // samples a second, > 0
    double start;   // s, time of the first sample; it applies before, too, and the last sample
                    // afterwards
    bool linear;    // linear interpolation, otherwise smooth
    // [count - 1], owned by its creator. If cut[i] is set, sample i applies until sample i + 1,
    // without interpolation. NULL if there are no cuts.
    bool *cut;
} SampleTimes;

// The value at a time is sum weight[i] sample[at[i]]. The weights' sum is 1; unused ones are 0.
typedef struct SampleSpan {
    uint32_t at[4];
    double weight[4];
    uint32_t near; // the last sample that is not later than the time
} SampleSpan;

// Uniform Catmull-Rom splines, which reproduce quadratic functions of time exactly (E. Catmull and
// R. Rom, "A class of local interpolating splines", 1974). At the ends and at cuts, the missing
// neighbour is extrapolated from three samples, or from two if there are no more.
SampleSpan sample_span(const SampleTimes *times, double time);
