// SPDX-License-Identifier: MIT
// Values that change over time, given at key times.
#pragma once

#include "base/error.h"

#include <stdint.h>

// Interpolation between keys. Both kinds pass through every key and are constant before the first
// and after the last key.
typedef enum Interpolation {
    // Monotone cubic Hermite (Fritsch and Butland 1984, as in PCHIP) for each component, with slope
    // 0 at both ends. Velocity is continuous, a held value stays held, and nothing overshoots. The
    // default, because a head whose velocity jumps tears at the hair.
    INTERPOLATION_SMOOTH,
    INTERPOLATION_LINEAR,
} Interpolation;

enum { KEYFRAMES_MAX_WIDTH = 4 };

// A zeroed struct is a valid track without keys.
typedef struct Keyframes {
    uint32_t count; // 0 if the track is not used
    uint32_t width; // components of a value, 1 .. KEYFRAMES_MAX_WIDTH
    Interpolation interpolation;
    double *time; // [count], s, strictly increasing, owned
    float *value; // [count][width], owned
} Keyframes;

// Appends a key. The first key of a zeroed struct sets the width. `time` must be finite and later
// than the last key; otherwise RESULT_BAD_INPUT with both times. RESULT_FAILED when memory is
// short.
Result keyframes_append(Keyframes *keys, double time, const float *value, uint32_t width,
                        Error *error);
void keyframes_destroy(Keyframes *keys);

// Writes the value at `time` (s, any finite number) to value[width]. There must be at least one
// key.
void keyframes_evaluate(const Keyframes *keys, double time, float *value);
