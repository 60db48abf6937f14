// SPDX-License-Identifier: MIT
#include "scene/keyframes.h"

#include <assert.h>
#include <math.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

Result keyframes_append(Keyframes *keys, double time, const float *value, uint32_t width,
                        Error *error)
{
    assert(width >= 1 && width <= KEYFRAMES_MAX_WIDTH &&
           (keys->count == 0 || keys->width == width));
    if (!isfinite(time))
        return error_set(error, RESULT_BAD_INPUT, "time: got %g, expected a finite number", time);
    if (keys->count > 0 && time <= keys->time[keys->count - 1])
        return error_set(
            error, RESULT_BAD_INPUT,
            "time: got %.9g s, expected more than %.9g s, the time of the previous key", time,
            keys->time[keys->count - 1]);
    uint32_t count = keys->count;
    // Room doubles when the count reaches a power of two.
    if ((count & (count - 1)) == 0) {
        size_t room = count ? 2 * (size_t)count : 1;
        double *times = realloc(keys->time, room * sizeof times[0]);
        if (times) keys->time = times;
        float *values = realloc(keys->value, room * width * sizeof values[0]);
        if (values) keys->value = values;
        if (!times || !values) return error_set(error, RESULT_FAILED, "out of memory");
    }
    keys->width = width;
    keys->time[count] = time;
    memcpy(keys->value + (size_t)count * width, value, width * sizeof value[0]);
    keys->count++;
    return RESULT_OK;
}

void keyframes_destroy(Keyframes *keys)
{
    free(keys->time);
    free(keys->value);
    *keys = (Keyframes){0};
}

// The last key that is not later than `time`, which must be in [first key, last key).
static uint32_t find_key(const Keyframes *keys, double time)
{
    uint32_t low = 0, high = keys->count - 1;
    while (high - low > 1) {
        uint32_t middle = low + (high - low) / 2;
        if (keys->time[middle] <= time)
            low = middle;
        else
            high = middle;
    }
    return low;
}

static double number_at(const Keyframes *keys, uint32_t key, uint32_t c)
{
    return (double)keys->value[(size_t)key * keys->width + c];
}

// The slope of component c between `key` and the next key, per second.
static double secant(const Keyframes *keys, uint32_t key, uint32_t c)
{
    return (number_at(keys, key + 1, c) - number_at(keys, key, c)) /
           (keys->time[key + 1] - keys->time[key]);
}

// The slope of component c at `key`: the harmonic mean of the two secants, weighted by the lengths
// of the intervals; 0 if the secants differ in sign (Fritsch and Butland 1984, 'A method for
// constructing local monotone piecewise cubic interpolants').
static double slope(const Keyframes *keys, uint32_t key, uint32_t c)
{
    if (key == 0 || key == keys->count - 1) return 0.0;
    double before = secant(keys, key - 1, c), after = secant(keys, key, c);
    if (!((before > 0 && after > 0) || (before < 0 && after < 0))) return 0.0;
    double h_before = keys->time[key] - keys->time[key - 1];
    double h_after = keys->time[key + 1] - keys->time[key];
    double w_before = h_before + 2 * h_after, w_after = 2 * h_before + h_after;
    return (w_before + w_after) / (w_before / before + w_after / after);
}

void keyframes_evaluate(const Keyframes *keys, double time, float *value)
{
    assert(keys->count > 0);
    uint32_t last = keys->count - 1;
    if (time <= keys->time[0] || time >= keys->time[last]) {
        uint32_t key = time <= keys->time[0] ? 0 : last;
        memcpy(value, keys->value + (size_t)key * keys->width, keys->width * sizeof value[0]);
        return;
    }
    uint32_t key = find_key(keys, time);
    double h = keys->time[key + 1] - keys->time[key], u = (time - keys->time[key]) / h;
    bool smooth = keys->interpolation == INTERPOLATION_SMOOTH;
    for (uint32_t c = 0; c < keys->width; c++) {
        double from = number_at(keys, key, c), to = number_at(keys, key + 1, c), at = u;
        double bend = 0.0;
        if (smooth) { // cubic Hermite polynomial
            at = u * u * (3 - 2 * u);
            bend = h * u * (1 - u) * ((1 - u) * slope(keys, key, c) - u * slope(keys, key + 1, c));
        }
        value[c] = (float)(from + at * (to - from) + bend);
    }
}
