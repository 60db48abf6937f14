// SPDX-License-Identifier: MIT
// Between samples at even times: which of them a time is made of, and by what shares.
#pragma once

#include <stdbool.h>
#include <stdint.h>

typedef struct SampleTimes {
    uint32_t count; // >= 1
    double rate;    // samples a second, > 0
    double start;   // s, the time of the first; it holds before, the last one after
    bool linear;    // straight between samples, else smooth
    bool *cut;      // [count - 1], owned by whoever made it: nothing lies between sample i and
                    // i + 1; i holds until i + 1. NULL: none
} SampleTimes;

// A time is sum weight[i] sample[at[i]]; the weights' sum is 1, those that are not needed are 0.
typedef struct SampleSpan {
    uint32_t at[4];
    double weight[4];
    uint32_t near; // the sample at the time or before it
} SampleSpan;

// Uniform Catmull-Rom splines, which are exact for whatever is quadratic in time (E. Catmull and
// R. Rom, "A class of local interpolating splines", 1974). At the ends and at cuts the missing
// neighbour is extrapolated from three samples, or from two where there are no more.
SampleSpan sample_span(const SampleTimes *times, double time);
