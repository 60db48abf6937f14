// SPDX-License-Identifier: MIT
// Values of a USD attribute over time.
#pragma once

#include "base/usd_text.h"

// Without `timed` there is at most one, the default.
typedef struct UsdSamples {
    UsdValues *sample;     // [count] by rising time
    size_t count, in_file; // in_file: of which some may not be kept
    bool timed;
} UsdSamples;

// Reads a default, or with `timed` the braces of timeSamples, which win over the default whatever
// comes first; without `all` the first of these is kept. Fails the reader where times do not rise.
void usd_samples_read(UsdSamples *samples, Reader *reader, bool timed, bool all);
void usd_samples_destroy(UsdSamples *samples);

// The two samples around a time, and how far behind the first one it is, 0 to 1. There is one at
// least.
double usd_samples_find(const UsdSamples *samples, double time, const float **a, const float **b);
