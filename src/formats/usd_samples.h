// SPDX-License-Identifier: MIT
// Values of a USD attribute over time.
#pragma once

#include "formats/usd_text.h"

// Without `timed` there is at most one sample, the default.
typedef struct UsdSamples {
    UsdValues *sample;     // [count] by ascending time
    size_t count, in_file; // in_file: number in the file, of which some may be dropped
    bool timed;
} UsdSamples;

// Reads a default value or, with `timed`, the braces of timeSamples, which override the default in
// any order; without `all` only the first sample is kept. Fails the reader if times do not ascend.
void usd_samples_read(UsdSamples *samples, Reader *reader, bool timed, bool all);
void usd_samples_destroy(UsdSamples *samples);

// The two samples around a time, and the place between them, 0 to 1. There must be at least one
// sample.
double usd_samples_find(const UsdSamples *samples, double time, const float **a, const float **b);
