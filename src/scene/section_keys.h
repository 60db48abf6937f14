// SPDX-License-Identifier: MIT
// The form of animated section parameters in scene files.
#pragma once

#include "base/json.h"
#include "scene/section_tracks.h"

// Reads {"keys": [...], "interpolation": ...} or {"formula": "..."}, and sets `params` to the value
// at time 0. Replaces an existing track of the parameter. RESULT_BAD_INPUT with the place, also for
// parameters that cannot be animated; RESULT_FAILED when memory is short.
Result section_keys_read(SectionTracks *tracks, SectionParams *params, const ParamInfo *info,
                         const JsonPlace *place, const json_t *value, Error *error);

// The track of a parameter in the form that section_keys_read reads; NULL if it has none (or if
// memory is short). The caller owns the reference.
json_t *section_keys_write(const SectionTracks *tracks, const ParamInfo *info);
