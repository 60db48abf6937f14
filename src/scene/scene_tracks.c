// SPDX-License-Identifier: MIT
#include "scene/scene_tracks.h"
#include "scene/scene_param.h"

#include "glsl/common/shared_math.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

const char *const INTERPOLATION_WORDS[] = {
    [INTERPOLATION_SMOOTH] = "smooth", [INTERPOLATION_LINEAR] = "linear", NULL};
const char *const LIGHT_KIND_WORDS[] = {
    [LIGHT_DIRECTIONAL] = "directional", [LIGHT_POINT] = "point", [LIGHT_SPOT] = "spot", NULL};

enum { MEMBERS_MAX = 3 };

// A track in a scene file: a member of its keys, and the key of its formulas.
typedef struct Member {
    const char *name, *formula; // `formula` is NULL if there are none
    Track *track;
    uint32_t width;
    TrackRange range;
    bool color; // may also be the text of a color
} Member;

static Result read_member(const Member *member, const JsonPlace *parent, const json_t *value,
                          double time, Error *error)
{
    JsonPlace place = {.parent = parent, .key = member->name};
    float numbers[KEYFRAMES_MAX_WIDTH] = {0};
    double number = 0;
    if (member->color && json_is_string(value)) {
        SectionParams holder = {0};
        TRY(scene_param_read(params_find("color"), &holder, NULL, &place, value, error));
        return keyframes_append(&member->track->keys, time, holder.color, 3, error);
    }
    TRY(member->width == 1
            ? json_read_number(&place, value, member->range.minimum, member->range.maximum,
                               "a number", &number, error)
            : json_read_vector(&place, value, member->width, member->range.minimum,
                               member->range.maximum, "an array of three numbers", numbers, error));
    if (member->width == 1) numbers[0] = (float)number;
    for (uint32_t i = 0; i < member->width; i++)
        numbers[i] = (float)((double)numbers[i] * member->range.scale);
    return keyframes_append(&member->track->keys, time, numbers, member->width, error);
}

// Reads one key: its time, which must be later than `*time` and replaces it, and at least one
// member. A member missing from a key is interpolated between the keys that have it.
static Result read_key(const Member *members, size_t count, const JsonPlace *place,
                       const json_t *key, double *time, Error *error)
{
    const char *names[MEMBERS_MAX + 2] = {"time"};
    for (size_t i = 0; i < count; i++) names[1 + i] = members[i].name;
    TRY(json_check_object(place, key, names, error));
    const json_t *time_value = json_object_get(key, "time");
    if (!time_value) return json_fail(place, error, "expected a key 'time' (s)");
    JsonPlace time_place = {.parent = place, .key = "time"};
    double before = *time;
    TRY(json_read_number(&time_place, time_value, -SCENE_TIME_MAX_S, SCENE_TIME_MAX_S, "seconds",
                         time, error));
    if (*time <= before)
        return json_fail(&time_place, error,
                         "got %.9g, expected more than %.9g, the time of the previous key", *time,
                         before);
    if (json_object_size(key) == 1)
        return json_fail(place, error, "expected a key '%s' beside 'time'", members[0].name);

    for (size_t i = 0; i < count; i++) {
        const json_t *value = json_object_get(key, members[i].name);
        if (value) TRY(read_member(&members[i], place, value, *time, error));
    }
    return RESULT_OK;
}

static Result read_interpolation(const JsonPlace *parent, const json_t *track, Interpolation *read,
                                 Error *error)
{
    const json_t *value = json_object_get(track, "interpolation");
    if (!value) return RESULT_OK;
    JsonPlace place = {.parent = parent, .key = "interpolation"};
    int index = 0;
    Result result = json_read_choice(&place, value, INTERPOLATION_WORDS, &index, error);
    *read = (Interpolation)index;
    return result;
}

// Reads "keys" and "interpolation".
static Result read_keys(const Member *members, size_t count, const JsonPlace *place,
                        const json_t *track, Error *error)
{
    Interpolation interpolation = INTERPOLATION_SMOOTH;
    TRY(read_interpolation(place, track, &interpolation, error));
    const json_t *keys = json_object_get(track, "keys");
    if (!keys) return json_fail(place, error, "expected a key 'keys'");
    JsonPlace keys_place = {.parent = place, .key = "keys"};
    if (!json_is_array(keys) || json_array_size(keys) == 0)
        return json_refuse(&keys_place, keys, "an array of one or more keys", error);
    double time = -INFINITY;
    for (size_t i = 0; i < json_array_size(keys); i++) {
        JsonPlace key_place = {.parent = &keys_place, .index = i};
        TRY(read_key(members, count, &key_place, json_array_get(keys, i), &time, error));
    }
    for (size_t i = 0; i < count; i++) members[i].track->keys.interpolation = interpolation;
    return RESULT_OK;
}

// Reads one formula of time; a number is a constant formula.
static Result read_formula(const Member *member, uint32_t component, const JsonPlace *place,
                           const json_t *value, Error *error)
{
    char number[32];
    Error why;
    snprintf(number, sizeof number, "%.9g", json_number_value(value));
    if (!json_is_number(value) && !json_is_string(value))
        return json_refuse(place, value, "a number or a formula of t", error);
    if (track_set_formula(member->track, component,
                          json_is_string(value) ? json_string_value(value) : number, &member->range,
                          &why) == RESULT_OK)
        return RESULT_OK;
    return json_fail(place, error, "%s", why.text);
}

// Reads a formula for each component, if there are any.
static Result read_formulas(const Member *member, const JsonPlace *parent, const json_t *object,
                            Error *error)
{
    const json_t *value = member->formula ? json_object_get(object, member->formula) : NULL;
    JsonPlace place = {.parent = parent, .key = member->formula};
    if (!value) return RESULT_OK;
    if (member->track->keys.count > 0)
        return json_fail(&place, error, "given here and by 'keys': expected only one of them");
    if (member->width == 1) return read_formula(member, 0, &place, value, error);
    if (!json_is_array(value) || json_array_size(value) != member->width)
        return json_refuse(&place, value, "an array of three numbers or formulas of t", error);
    for (uint32_t i = 0; i < member->width; i++) {
        JsonPlace element = {.parent = &place, .index = i};
        TRY(read_formula(member, i, &element, json_array_get(value, i), error));
    }
    return RESULT_OK;
}

// Reads an object with "keys" and "interpolation", or with formulas, or with both for different
// members. `other` is a key that the caller reads, or NULL.
static Result read_tracks(const Member *members, size_t count, const char *other,
                          const JsonPlace *place, const json_t *object, Error *error)
{
    const char *names[MEMBERS_MAX + 4] = {"keys", "interpolation"};
    size_t named = 2;
    bool by_formula = false;
    if (other) names[named++] = other;
    for (size_t i = 0; i < count; i++) {
        if (!members[i].formula) continue;
        names[named++] = members[i].formula;
        by_formula = by_formula || json_object_get(object, members[i].formula);
    }
    TRY(json_check_object(place, object, names, error));
    bool by_keys = json_object_get(object, "keys") || json_object_get(object, "interpolation");
    if (by_keys || !by_formula) TRY(read_keys(members, count, place, object, error));
    for (size_t i = 0; i < count; i++) TRY(read_formulas(&members[i], place, object, error));
    return RESULT_OK;
}

static TrackRange range_of(const ParamInfo *info)
{
    return (TrackRange){info->minimum, info->maximum, 1.0};
}

Result scene_tracks_read_force(Track *track, const ParamInfo *info, const JsonPlace *place,
                               const json_t *value, Error *error)
{
    Member member = {"value", "formula", track, 3, range_of(info), false};
    return read_tracks(&member, 1, NULL, place, value, error);
}

Result scene_tracks_read_number(Track *track, const ParamInfo *info, bool color,
                                const JsonPlace *place, const json_t *value, Error *error)
{
    Member member = {"value",       color ? NULL : "formula", track,
                     color ? 3 : 1, range_of(info),           color};
    JsonPlace formula = {.parent = place, .key = "formula"};
    if (color && json_object_get(value, "formula"))
        return json_fail(&formula, error, "a color has no formula: expected 'keys'");
    return read_tracks(&member, 1, NULL, place, value, error);
}

// Reads a point or a direction; keeps the present value if the member is missing.
static Result read_vector(float to[3], const JsonPlace *parent, const json_t *object,
                          const char *key, bool needed, Error *error)
{
    const json_t *value = json_object_get(object, key);
    JsonPlace place = {.parent = parent, .key = key};
    if (!value && needed) return json_fail(parent, error, "expected a key '%s'", key);
    if (!value) return RESULT_OK;
    return json_read_vector(&place, value, 3, -SCENE_OFFSET_MAX, SCENE_OFFSET_MAX,
                            "an array of three numbers", to, error);
}

Result scene_tracks_read_head(RigidTrack *head, const JsonPlace *place, const json_t *value,
                              Error *error)
{
    const Member members[] = {
        {"translate", "translate", &head->translation, 3, RIGID_TRACK_METRES, false},
        {"rotate", "rotate", &head->rotation, 3, RIGID_TRACK_DEGREES, false},
    };
    TRY(read_tracks(members, 2, "pivot", place, value, error));
    return read_vector(head->pivot, place, value, "pivot", false, error);
}

Result scene_tracks_read_camera(Scene *scene, const JsonPlace *place, const json_t *value,
                                Error *error)
{
    const TrackRange point = range_of(params_find("eye")), angle = range_of(params_find("fov"));
    const Member members[] = {
        {"eye", "eye", &scene->eye, 3, point, false},
        {"target", "target", &scene->target, 3, point, false},
        {"fov", "fov", &scene->fov, 1, angle, false},
    };
    return read_tracks(members, 3, NULL, place, value, error);
}

// Reads a unit vector: for a directional light against the direction of travel, for a spot along
// it.
static Result read_direction(Light *light, const JsonPlace *parent, const json_t *object,
                             Error *error)
{
    float way[3];
    TRY(read_vector(way, parent, object, "direction", true, error));
    double length = hypot(hypot((double)way[0], (double)way[1]), (double)way[2]);
    JsonPlace place = {.parent = parent, .key = "direction"};
    if (length == 0)
        return json_refuse(&place, json_object_get(object, "direction"), "a direction", error);
    // A unit vector rounded to float may have this error in its length. It is not normalised again,
    // so that writing and reading a scene does not change it.
    if (fabs(length - 1) <= 0x1p-24) length = 1;
    double sign = light->kind == LIGHT_SPOT ? 1 : -1;
    for (int i = 0; i < 3; i++) light->direction[i] = (float)(sign * (double)way[i] / length + 0.0);
    return RESULT_OK;
}

// Reads a color like that of the parameter `color` and makes it linear.
static Result read_light_color(Light *light, const JsonPlace *parent, const json_t *object,
                               Error *error)
{
    const json_t *value = json_object_get(object, "color");
    if (!value) return RESULT_OK;
    JsonPlace place = {.parent = parent, .key = "color"};
    SectionParams holder = {0};
    Result result = scene_param_read(params_find("color"), &holder, NULL, &place, value, error);
    for (int i = 0; i < 3; i++) light->color[i] = (float)srgb_decode((double)holder.color[i]);
    return result;
}

// Reads an optional number.
static Result read_quantity(float *quantity, const JsonPlace *parent, const json_t *object,
                            const char *key, double minimum, double maximum, const char *expected,
                            Error *error)
{
    const json_t *value = json_object_get(object, key);
    JsonPlace place = {.parent = parent, .key = key};
    double number = (double)*quantity;
    if (!value) return RESULT_OK;
    Result result = json_read_number(&place, value, minimum, maximum, expected, &number, error);
    *quantity = (float)number;
    return result;
}

static Result read_cone(Light *light, const JsonPlace *place, const json_t *value, Error *error)
{
    TRY(read_quantity(&light->outer_deg, place, value, "outer", SCENE_CONE_MIN, SCENE_CONE_MAX,
                      "degrees", error));
    TRY(read_quantity(&light->inner_deg, place, value, "inner", 0, SCENE_CONE_MAX, "degrees",
                      error));
    if (light->inner_deg < light->outer_deg) return RESULT_OK;
    return json_fail(place, error, "'inner' is %.9g deg, expected less than 'outer', %.9g deg",
                     (double)light->inner_deg, (double)light->outer_deg);
}

static Result read_light_shadow(Light *light, const JsonPlace *parent, const json_t *object,
                                Error *error)
{
    const json_t *value = json_object_get(object, "shadow");
    const JsonPlace place = {.parent = parent, .key = "shadow"};
    if (value && !json_is_boolean(value)) return json_refuse(&place, value, "true or false", error);
    if (value) light->shadow = json_is_true(value);
    return RESULT_OK;
}

// `light` must hold the defaults.
static Result read_light(Light *light, const JsonPlace *place, const json_t *value, Error *error)
{
    static const char *const DIRECTIONAL[] = {"type",   "direction", "color", "intensity",
                                              "radius", "shadow",    NULL};
    static const char *const POINT[] = {"type",      "position", "distance", "color",
                                        "intensity", "radius",   "shadow",   NULL};
    static const char *const SPOT[] = {"type",   "position", "distance", "direction",
                                       "inner",  "outer",    "color",    "intensity",
                                       "radius", "shadow",   NULL};
    static const char *const *const NAMES[] = {
        [LIGHT_DIRECTIONAL] = DIRECTIONAL, [LIGHT_POINT] = POINT, [LIGHT_SPOT] = SPOT};
    const json_t *type = json_object_get(value, "type");
    JsonPlace type_place = {.parent = place, .key = "type"};
    int kind = LIGHT_DIRECTIONAL;
    if (type) TRY(json_read_choice(&type_place, type, LIGHT_KIND_WORDS, &kind, error));
    light->kind = (LightKind)kind;
    TRY(json_check_object(place, value, NAMES[kind], error));
    TRY(read_quantity(&light->intensity, place, value, "intensity", 0, SCENE_INTENSITY_MAX,
                      "a factor", error));
    TRY(read_quantity(&light->radius, place, value, "radius", 0,
                      kind == LIGHT_DIRECTIONAL ? SCENE_WIDE_MOST : SCENE_OFFSET_MAX,
                      kind == LIGHT_DIRECTIONAL ? "degrees" : "metres", error));
    if (kind != LIGHT_POINT) TRY(read_direction(light, place, value, error));
    if (kind != LIGHT_DIRECTIONAL) {
        TRY(read_vector(light->position, place, value, "position", true, error));
        TRY(read_quantity(&light->distance, place, value, "distance", SCENE_LIGHT_NEAREST,
                          SCENE_OFFSET_MAX, "metres", error));
    }
    if (kind == LIGHT_SPOT) TRY(read_cone(light, place, value, error));
    TRY(read_light_color(light, place, value, error));
    return read_light_shadow(light, place, value, error);
}

Result scene_tracks_read_lights(Scene *scene, const JsonPlace *place, const json_t *value,
                                Error *error)
{
    size_t count = json_array_size(value);
    if (!json_is_array(value)) return json_refuse(place, value, "an array of lights", error);
    if (count > SCENE_MAX_LIGHTS)
        return json_fail(place, error, "got %zu lights, expected %d at most", count,
                         SCENE_MAX_LIGHTS);
    scene->light_count = 0;
    scene->own_lights = true;
    for (size_t i = 0; i < count; i++) {
        JsonPlace light_place = {.parent = place, .index = i};
        scene->lights[i] = (Light){
            .color = {1, 1, 1}, .intensity = 1, .distance = 1, .outer_deg = 45, .shadow = i == 0};
        TRY(read_light(&scene->lights[i], &light_place, json_array_get(value, i), error));
        scene->light_count++;
    }
    return RESULT_OK;
}
