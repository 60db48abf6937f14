// SPDX-License-Identifier: MIT
#include "scene/section_keys.h"
#include "scene/scene_param.h"
#include "scene/scene_tracks.h"

Result section_keys_read(SectionTracks *tracks, SectionParams *params, const ParamInfo *info,
                         const JsonPlace *place, const json_t *value, Error *error)
{
    const char *why = section_tracks_refusal(info);
    if (why)
        return json_fail(place, error,
                         "got an object, expected one value (it cannot change over time: %s)", why);
    section_tracks_drop(tracks, info);
    SectionTrack *track = section_tracks_add(tracks, info, error);
    if (!track) return RESULT_FAILED;
    TRY(scene_tracks_read_number(&track->track, info, section_tracks_is_color(info), place, value,
                                 error));
    section_tracks_apply(tracks, 0, params);
    return RESULT_OK;
}

json_t *section_keys_write(const SectionTracks *tracks, const ParamInfo *info)
{
    const SectionTrack *found = section_tracks_find(tracks, info);
    if (!found) return NULL;
    const Track *track = &found->track;
    if (!track->keys.count) return json_pack("{s:s}", "formula", track->formula[0].text);
    json_t *keys = json_array();
    uint32_t width = track->keys.width;
    for (uint32_t i = 0; i < track->keys.count; ++i) {
        const float *value = &track->keys.value[(size_t)i * width];
        json_array_append_new(keys, json_pack("{s:f, s:o}", "time", track->keys.time[i], "value",
                                              width > 1 ? scene_param_write_floats(value, width)
                                                        : scene_param_write_float(value[0])));
    }
    return json_pack("{s:o, s:s}", "keys", keys, "interpolation",
                     INTERPOLATION_WORDS[track->keys.interpolation]);
}
