// SPDX-License-Identifier: MIT
#include "scene/section_keys.h"
#include "scene/scene_param.h"
#include "scene/scene_tracks.h"

static Result read_formula(Formula *formula, const ParamInfo *info, const JsonPlace *parent,
                           const json_t *object, Error *error)
{
    static const char *const NAMES[] = {"formula", NULL};
    const json_t *value = json_object_get(object, "formula");
    JsonPlace place = {.parent = parent, .key = "formula"};
    Error why;
    TRY(json_check_object(parent, object, NAMES, error));
    if (section_tracks_is_color(info))
        return json_fail(&place, error, "a color has no formula: expected 'keys'");
    if (!json_is_string(value)) return json_refuse(&place, value, "a formula of t", error);
    if (formula_create(formula, json_string_value(value), &why) == RESULT_OK) return RESULT_OK;
    return json_fail(&place, error, "%s", why.text);
}

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
    if (json_object_get(value, "formula"))
        TRY(read_formula(&track->formula, info, place, value, error));
    else
        TRY(scene_tracks_read_numbers(&track->keys, info, section_tracks_is_color(info), place,
                                      value, error));
    section_tracks_apply(tracks, 0, params);
    return RESULT_OK;
}

json_t *section_keys_write(const SectionTracks *tracks, const ParamInfo *info)
{
    const SectionTrack *track = section_tracks_find(tracks, info);
    if (!track) return NULL;
    if (!track->keys.count) return json_pack("{s:s}", "formula", track->formula.text);
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
