// SPDX-License-Identifier: MIT
// Section parameters that change over time, by keys or by a formula.
#pragma once

#include "base/params.h"
#include "scene/track.h"

typedef struct SectionTrack {
    const ParamInfo *info;
    Track track; // in the parameter's unit: 1 number, or 3 of a colour (sRGB)
} SectionTrack;

// A zeroed struct has no tracks.
typedef struct SectionTracks {
    SectionTrack *list; // [count], owned
    uint32_t count;
} SectionTracks;

void section_tracks_destroy(SectionTracks *tracks);

// NULL if the parameter may be animated; otherwise the reason why not, for messages.
const char *section_tracks_refusal(const ParamInfo *info);

// Removes the track of a parameter, if there is one, because another value was given.
void section_tracks_drop(SectionTracks *tracks, const ParamInfo *info);

// RESULT_FAILED when memory is short. `to` must be empty.
Result section_tracks_copy(SectionTracks *to, const SectionTracks *from, Error *error);

// Sets `params` to the values at a time (s). Values of formulas are clamped to the parameter's
// range.
void section_tracks_apply(const SectionTracks *tracks, double time, SectionParams *params);

// Sets each parameter to the greatest value of its track (track_extremes).
void section_tracks_greatest(const SectionTracks *tracks, double last, int count,
                             SectionParams *params);

// Checks that all formulas are finite and within their parameters' ranges at a time;
// RESULT_BAD_INPUT with the parameter's name and the value.
Result section_tracks_check(const SectionTracks *tracks, double time, Error *error);

// A stamp of the values: equal stamps mean equal values.
uint64_t section_tracks_stamp(const SectionTracks *tracks, const SectionParams *params);

bool section_tracks_has(const SectionTracks *tracks, const ParamInfo *info);

// The track of a parameter, or NULL; a new track without keys or formula (NULL and a message when
// memory is short).
SectionTrack *section_tracks_find(const SectionTracks *tracks, const ParamInfo *info);
SectionTrack *section_tracks_add(SectionTracks *tracks, const ParamInfo *info, Error *error);

// Whether the parameter is a colour, which has three components.
bool section_tracks_is_color(const ParamInfo *info);
