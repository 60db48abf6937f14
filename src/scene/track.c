// SPDX-License-Identifier: MIT
#include "scene/track.h"

#include "base/double3.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

Result track_set_formula(Track *track, uint32_t i, const char *text, const TrackRange *range,
                         Error *error)
{
    track->range = *range;
    return formula_create(&track->formula[i], text, error);
}

bool track_has_formula(const Track *track)
{
    return track->formula[0].text;
}

bool track_is_given(const Track *track)
{
    return track->keys.count > 0 || track_has_formula(track);
}

bool track_is_still(const Track *track)
{
    return track->keys.count < 2 && !track->formula[0].text;
}

void track_evaluate(const Track *track, double time, float *value)
{
    const TrackRange *range = &track->range;
    if (track->keys.count) keyframes_evaluate(&track->keys, time, value);
    for (int i = 0; i < TRACK_MAX_WIDTH && track->formula[i].text; ++i) {
        double number = formula_evaluate(&track->formula[i], time);
        if (isnan(number)) number = 0;
        value[i] = (float)(range->scale * fmin(fmax(number, range->minimum), range->maximum));
    }
}

void track_evaluate_or(const Track *track, const float constant[3], double time, float value[3])
{
    if (track_is_given(track))
        track_evaluate(track, time, value);
    else
        memcpy(value, constant, 3 * sizeof *value);
}

Result track_check(const Track *track, const char *name, double time, Error *error)
{
    const TrackRange *range = &track->range;
    for (int i = 0; i < TRACK_MAX_WIDTH && track->formula[i].text; ++i) {
        double number = formula_evaluate(&track->formula[i], time);
        if (number >= range->minimum && number <= range->maximum) continue;
        char index[16] = "";
        if (track->formula[1].text) snprintf(index, sizeof index, "[%d]", i);
        return error_set(error, RESULT_BAD_INPUT,
                         "%s%s: '%.100s' is %g at t = %.9g, expected %.10g to %.10g", name, index,
                         track->formula[i].text, number, time, range->minimum, range->maximum);
    }
    return RESULT_OK;
}

static double sample_time(const Track *track, int sample, int count, double last)
{
    return track->keys.count ? track->keys.time[sample] : last * sample / fmax(count - 1, 1);
}

TrackExtremes track_extremes(const Track *track, int count, double last)
{
    const int most = 10000, samples = count < most ? count : most,
              times = track->keys.count ? (int)track->keys.count : samples;
    TrackExtremes found = {.length = 0};
    for (int i = 0; i < times; ++i) {
        float value[TRACK_MAX_WIDTH] = {0};
        track_evaluate(track, sample_time(track, i, samples, last), value);
        for (int k = 0; k < TRACK_MAX_WIDTH; ++k) {
            found.least[k] = i ? fminf(found.least[k], value[k]) : value[k];
            found.greatest[k] = i ? fmaxf(found.greatest[k], value[k]) : value[k];
        }
        Double3 vector;
        double3_from_float(value, vector);
        found.length = fmax(found.length, double3_length(vector));
    }
    return found;
}

Result track_copy(Track *to, const Track *from, Error *error)
{
    to->range = from->range;
    for (int i = 0; i < TRACK_MAX_WIDTH && from->formula[i].text; ++i)
        TRY(formula_create(&to->formula[i], from->formula[i].text, error));
    for (uint32_t k = 0; k < from->keys.count; ++k)
        TRY(keyframes_append(&to->keys, from->keys.time[k],
                             &from->keys.value[(size_t)k * from->keys.width], from->keys.width,
                             error));
    to->keys.interpolation = from->keys.interpolation;
    return RESULT_OK;
}

void track_destroy(Track *track)
{
    keyframes_destroy(&track->keys);
    for (int i = 0; i < TRACK_MAX_WIDTH; ++i) formula_destroy(&track->formula[i]);
    *track = (Track){0};
}
