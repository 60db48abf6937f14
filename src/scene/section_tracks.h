// SPDX-License-Identifier: MIT
// Parameters of a section that change over time: by keys or by a formula.
#pragma once

#include "base/formula.h"
#include "base/params.h"
#include "scene/keyframes.h"

typedef struct SectionTrack {
    const ParamInfo *info;
    Keyframes keys;  // numbers as the parameter has them: 1, or 3 of a colour (sRGB)
    Formula formula; // if there are no keys
} SectionTrack;

// A zeroed one has no tracks.
typedef struct SectionTracks {
    SectionTrack *list; // [count], owned
    uint32_t count;
} SectionTracks;

void section_tracks_destroy(SectionTracks *tracks);

// NULL if the parameter may change over time; else the reason why it may not, for messages.
const char *section_tracks_refusal(const ParamInfo *info);

// Forgets the track of a parameter, if there is one: another value has been given.
void section_tracks_drop(SectionTracks *tracks, const ParamInfo *info);

// RESULT_FAILED when memory is short. `to` must be empty.
Result section_tracks_copy(SectionTracks *to, const SectionTracks *from, Error *error);

// Gives `params` the values at a time (s). What a formula has beyond the parameter's range counts
// as the nearest number within it.
void section_tracks_apply(const SectionTracks *tracks, double time, SectionParams *params);

// The greatest number that each has at one of `count` times from 0 to `last` (s), or at a key.
void section_tracks_greatest(const SectionTracks *tracks, double last, int count,
                             SectionParams *params);

// Whether all formulas are finite and within their parameters' ranges at a time; RESULT_BAD_INPUT
// with the parameter's name and the value.
Result section_tracks_check(const SectionTracks *tracks, double time, Error *error);

// A number that is equal for two times only if all values are.
uint64_t section_tracks_stamp(const SectionTracks *tracks, const SectionParams *params);

bool section_tracks_has(const SectionTracks *tracks, const ParamInfo *info);

// The track of a parameter, or NULL; a new one without keys or formula (NULL and RESULT_FAILED's
// message when memory is short).
SectionTrack *section_tracks_find(const SectionTracks *tracks, const ParamInfo *info);
SectionTrack *section_tracks_add(SectionTracks *tracks, const ParamInfo *info, Error *error);

// Whether the parameter is a colour, which has three numbers.
bool section_tracks_is_color(const ParamInfo *info);
