// SPDX-License-Identifier: MIT
// A value that changes over time: given by keys, or by a formula for each of its components.
#pragma once

#include "base/formula.h"
#include "scene/keyframes.h"

enum { TRACK_MAX_WIDTH = 3 };

// The range of a value in the unit of scene files, and the factor from there to the unit in which
// the program stores it.
typedef struct TrackRange {
    double minimum, maximum, scale;
} TrackRange;

// A zeroed struct is a track that is not given.
typedef struct Track {
    Keyframes keys;                   // in the stored unit
    Formula formula[TRACK_MAX_WIDTH]; // in the unit of scene files; one for each component, or none
    TrackRange range;                 // of the formulas
} Track;

// Gives component `i` (0 .. TRACK_MAX_WIDTH - 1) of a track without keys a formula of t. Components
// are set in order. RESULT_BAD_INPUT with the error in the formula, RESULT_FAILED when memory is
// short.
Result track_set_formula(Track *track, uint32_t i, const char *text, const TrackRange *range,
                         Error *error);

bool track_is_given(const Track *track);
bool track_has_formula(const Track *track);

// Whether the value is the same at all times. Formulas are not analysed: a track with formulas is
// taken to change.
bool track_is_still(const Track *track);

// Writes the value at `time` (s). The track must be given. A formula's value is clamped to the
// range; NaN counts as 0. Not thread-safe, because formulas are not.
void track_evaluate(const Track *track, double time, float *value);

// The same for a track of width 3; `constant` is the value if the track is not given.
void track_evaluate_or(const Track *track, const float constant[3], double time, float value[3]);

// Checks that all formulas are finite and in their range at `time` (s); RESULT_BAD_INPUT with
// `name` and the value.
Result track_check(const Track *track, const char *name, double time, Error *error);

// The least and the greatest value of each component, and the greatest length.
typedef struct TrackExtremes {
    float least[TRACK_MAX_WIDTH], greatest[TRACK_MAX_WIDTH];
    double length;
} TrackExtremes;

// The extremes of a given track, at its keys: components do not overshoot between keys. The length
// of a vector can, by at most sqrt(3) times, where keys are smooth and components change at
// different times. For formulas at `count` (at least 1) even times from 0 to `last` (s), at
// most 10,000. Callers pass the times of frames, so what a formula does between frames is missed.
TrackExtremes track_extremes(const Track *track, int count, double last);

// RESULT_FAILED when memory is short. `to` must be zeroed.
Result track_copy(Track *to, const Track *from, Error *error);
void track_destroy(Track *track);
