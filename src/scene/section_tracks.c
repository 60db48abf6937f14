// SPDX-License-Identifier: MIT
#include "scene/section_tracks.h"

#include <math.h>
#include <stddef.h>
#include <stdlib.h>
#include <string.h>

void section_tracks_destroy(SectionTracks *tracks)
{
    for (uint32_t i = 0; i < tracks->count; ++i) track_destroy(&tracks->list[i].track);
    free(tracks->list);
    *tracks = (SectionTracks){0};
}

// --- Which parameters may change.

static bool lists(const char *names, const char *name)
{
    size_t length = strlen(name);
    for (const char *at = names; (at = strstr(at, name)); at += length)
        if ((at == names || at[-1] == ' ') && (at[length] == 0 || at[length] == ' ')) return true;
    return false;
}

const char *section_tracks_refusal(const ParamInfo *info)
{
    static const struct {
        const char *names, *why;
    } REFUSED[] = {
        {"refraction azimuthal_roughness", "tables are made for it once, at the start"},
        {"tip_length tip_color", "it is in the strands' paint, which is made once"},
        {"follower_radius", "followers are planned once, at the start"},
        {"sleep", "it is a tolerance of the whole run"},
    };
    if (info->scope != SCOPE_SECTION) return "it belongs to the run";
    for (size_t i = 0; i < sizeof REFUSED / sizeof *REFUSED; ++i)
        if (lists(REFUSED[i].names, info->name)) return REFUSED[i].why;
    switch (info->kind) {
    case PARAM_FLOAT:
    case PARAM_PROFILE:
    case PARAM_AUTO_FLOAT:
    case PARAM_COLOR:
    case PARAM_AUTO_COLOR:
        return NULL;
    case PARAM_INT:
    case PARAM_UINT:
    case PARAM_AUTO_INT:
        return "it is a count, which is decided once, at the start";
    default:
        return "it is not a number, and it is decided once, at the start";
    }
}

bool section_tracks_is_color(const ParamInfo *info)
{
    return info->kind == PARAM_COLOR || info->kind == PARAM_AUTO_COLOR;
}

static uint32_t width_of(const ParamInfo *info)
{
    return section_tracks_is_color(info) ? 3 : 1;
}

// --- Values.

static void put_value(const ParamInfo *info, SectionParams *params, const float *value)
{
    void *field = (char *)params + info->offset;
    ProfileNumber *profile = field;
    AutoFloat *number = field;
    AutoVec3 *color = field;
    switch (info->kind) {
    case PARAM_PROFILE:
        profile->mean = value[0];
        profile->along.count = 0;
        break;
    case PARAM_AUTO_FLOAT:
        *number = (AutoFloat){false, value[0]};
        break;
    case PARAM_AUTO_COLOR:
        color->automatic = false;
        memcpy(color->value, value, sizeof color->value);
        break;
    default:
        memcpy(field, value, width_of(info) * sizeof *value);
    }
}

void section_tracks_apply(const SectionTracks *tracks, double time, SectionParams *params)
{
    for (uint32_t i = 0; i < tracks->count; ++i) {
        float value[3] = {0};
        track_evaluate(&tracks->list[i].track, time, value);
        put_value(tracks->list[i].info, params, value);
    }
}

void section_tracks_greatest(const SectionTracks *tracks, double last, int count,
                             SectionParams *params)
{
    for (uint32_t i = 0; i < tracks->count; ++i) {
        const Track *track = &tracks->list[i].track;
        put_value(tracks->list[i].info, params, track_extremes(track, count, last).greatest);
    }
}

Result section_tracks_check(const SectionTracks *tracks, double time, Error *error)
{
    for (uint32_t i = 0; i < tracks->count; ++i)
        TRY(track_check(&tracks->list[i].track, tracks->list[i].info->name, time, error));
    return RESULT_OK;
}

uint64_t section_tracks_stamp(const SectionTracks *tracks, const SectionParams *params)
{
    uint64_t stamp = UINT64_C(0xcbf29ce484222325); // FNV-1a
    for (uint32_t i = 0; i < tracks->count; ++i) {
        const ParamInfo *info = tracks->list[i].info;
        const char *field = (const char *)params + info->offset;
        if (info->kind == PARAM_AUTO_FLOAT) field += offsetof(AutoFloat, value);
        if (info->kind == PARAM_AUTO_COLOR) field += offsetof(AutoVec3, value);
        for (size_t b = 0; b < width_of(info) * sizeof(float); ++b)
            stamp = (stamp ^ (uint8_t)field[b]) * UINT64_C(0x100000001b3);
    }
    return stamp;
}

// --- The list.

SectionTrack *section_tracks_find(const SectionTracks *tracks, const ParamInfo *info)
{
    for (uint32_t i = 0; i < tracks->count; ++i)
        if (tracks->list[i].info == info) return &tracks->list[i];
    return NULL;
}

bool section_tracks_has(const SectionTracks *tracks, const ParamInfo *info)
{
    return section_tracks_find(tracks, info) != NULL;
}

void section_tracks_drop(SectionTracks *tracks, const ParamInfo *info)
{
    SectionTrack *track = section_tracks_find(tracks, info);
    if (!track) return;
    track_destroy(&track->track);
    *track = tracks->list[--tracks->count];
}

SectionTrack *section_tracks_add(SectionTracks *tracks, const ParamInfo *info, Error *error)
{
    SectionTrack *list = realloc(tracks->list, (tracks->count + 1) * sizeof *list);
    if (!list) {
        error_set(error, RESULT_FAILED, "out of memory");
        return NULL;
    }
    tracks->list = list;
    list[tracks->count] = (SectionTrack){.info = info};
    return &list[tracks->count++];
}

Result section_tracks_copy(SectionTracks *to, const SectionTracks *from, Error *error)
{
    for (uint32_t i = 0; i < from->count; ++i) {
        const SectionTrack *track = &from->list[i];
        SectionTrack *copy = section_tracks_add(to, track->info, error);
        if (!copy) return RESULT_FAILED;
        TRY(track_copy(&copy->track, &track->track, error));
    }
    return RESULT_OK;
}
