// SPDX-License-Identifier: MIT
#include "mesh/sample_span.h"

#include <math.h>

static bool cut_behind(const SampleTimes *times, uint32_t sample)
{
    return sample + 1 >= times->count || (times->cut && times->cut[sample]);
}

static bool cut_before(const SampleTimes *times, uint32_t sample)
{
    return sample == 0 || (times->cut && times->cut[sample - 1]);
}

// weight[0] is that of a sample before the first. Replaces it by p[-1] = 3 p[0] - 3 p[1] + p[2].
static void extrapolate(double *missing, double *first, double *second, double *third, bool three)
{
    double w = *missing;
    *missing = 0;
    *first += three ? 3 * w : 2 * w;
    *second -= three ? 3 * w : w;
    *third += three ? w : 0;
}

static void make_smooth(SampleSpan *span, const SampleTimes *times, uint32_t k, double u)
{
    double *w = span->weight, uu = u * u, uuu = uu * u;
    bool before = !cut_before(times, k), behind = !cut_behind(times, k + 1);
    w[0] = 0.5 * (2 * uu - u - uuu);
    w[1] = 0.5 * (2 - 5 * uu + 3 * uuu);
    w[2] = 0.5 * (u + 4 * uu - 3 * uuu);
    w[3] = 0.5 * (uuu - uu);
    if (!before) extrapolate(&w[0], &w[1], &w[2], &w[3], behind);
    if (!behind) extrapolate(&w[3], &w[2], &w[1], &w[0], before);
    span->at[0] = before ? k - 1 : k;
    span->at[3] = behind ? k + 2 : k + 1;
}

SampleSpan sample_span(const SampleTimes *times, double time)
{
    // Rounds times that are nearly those of a sample, so that a cut happens at its sample.
    const double rounding = 1e-6;
    double last = times->count - 1.0, x = fmin(fmax((time - times->start) * times->rate, 0), last);
    if (!(x > 0)) x = 0; // also if NaN
    if (fabs(x - round(x)) < rounding) x = round(x);
    uint32_t k = (uint32_t)x;
    double u = x - k;
    SampleSpan span = {.at = {k, k, k, k}, .weight = {0, 1, 0, 0}, .near = k};
    if (u <= 0 || cut_behind(times, k)) return span;
    span.at[2] = span.at[3] = k + 1;
    if (times->linear)
        span.weight[1] = 1 - u, span.weight[2] = u;
    else
        make_smooth(&span, times, k, u);
    return span;
}
