// SPDX-License-Identifier: MIT
// Parameters that change over time as scene files have them.
#pragma once

#include "base/json.h"
#include "scene/section_tracks.h"

// Reads {"keys": [...], "interpolation": ...} or {"formula": "..."} and gives `params` the value at
// time 0. It replaces a track of the same parameter. RESULT_BAD_INPUT with the place, also for
// parameters that may not change; RESULT_FAILED when memory is short.
Result section_keys_read(SectionTracks *tracks, SectionParams *params, const ParamInfo *info,
                         const JsonPlace *place, const json_t *value, Error *error);

// The track of a parameter as section_keys_read has it, or NULL if it has none (or memory is
// short). The caller owns the reference.
json_t *section_keys_write(const SectionTracks *tracks, const ParamInfo *info);
