// SPDX-License-Identifier: MIT
// Writes a scene as JSON. jansson's functions accept NULL for a value and then fail. So a failed
// allocation needs to be checked only where a value is put into its parent.
#include "scene/scene_param.h"
#include "scene/scene_tracks.h"
#include "scene/section_keys.h"

#include "glsl/common/shared_math.h"

#include <math.h>
#include <string.h>

// Puts `value` into `object` and takes over its reference. False if either is NULL or memory is
// short.
static bool put(json_t *object, const char *key, json_t *value)
{
    return json_object_set_new(object, key, value) == 0;
}

// Returns `json` if all went well, otherwise frees it.
static json_t *finish(json_t *json, bool good)
{
    if (json && good) return json;
    json_decref(json);
    return NULL;
}

static json_t *write_value(const Keyframes *keys, uint32_t key, double scale)
{
    float scaled[KEYFRAMES_MAX_WIDTH];
    for (uint32_t i = 0; i < keys->width; i++)
        scaled[i] = (float)((double)keys->value[(size_t)key * keys->width + i] * scale);
    return keys->width == 1 ? scene_param_write_float(scaled[0])
                            : scene_param_write_floats(scaled, keys->width);
}

// A track, the member `name` of keys, the key of its formulas.
typedef struct Written {
    const char *name, *formula;
    const Track *track;
    double scale;  // to the unit of the file
    uint32_t next; // the first key not yet written
} Written;

// The earliest time of the keys that are not yet written; infinity if there are none.
static double next_time(const Written *tracks, size_t count)
{
    double time = INFINITY;
    for (size_t i = 0; i < count; i++) {
        const Keyframes *keys = &tracks[i].track->keys;
        if (tracks[i].next < keys->count) time = fmin(time, keys->time[tracks[i].next]);
    }
    return time;
}

// Puts "keys" and "interpolation" into the object, with each time once, if there are keys.
static bool write_keys(json_t *object, Written *tracks, size_t count)
{
    json_t *array = json_array();
    Interpolation interpolation = INTERPOLATION_SMOOTH;
    bool good = true;
    if (isinf(next_time(tracks, count))) {
        json_decref(array);
        return true;
    }
    for (double time; isfinite(time = next_time(tracks, count));) {
        json_t *key = json_object();
        good = put(key, "time", json_real(time)) && good;
        for (size_t i = 0; i < count; i++) {
            Written *track = &tracks[i];
            const Keyframes *keys = &track->track->keys;
            if (track->next == keys->count || keys->time[track->next] != time) continue;
            interpolation = keys->interpolation;
            good = put(key, track->name, write_value(keys, track->next, track->scale)) && good;
            track->next++;
        }
        good = json_array_append_new(array, key) == 0 && good;
    }
    good = put(object, "keys", array) && good;
    return put(object, "interpolation", json_string(INTERPOLATION_WORDS[interpolation])) && good;
}

// One text, or an array of three.
static json_t *write_formulas(const Track *track)
{
    if (!track->formula[1].text) return scene_param_write_text(track->formula[0].text);
    json_t *array = json_array();
    bool good = true;
    for (int i = 0; i < 3; i++)
        good = json_array_append_new(array, scene_param_write_text(track->formula[i].text)) == 0 &&
               good;
    return finish(array, good);
}

// An object that scene_tracks.c reads. An empty object if no track is given, NULL if memory is
// short.
static json_t *write_tracks(Written *tracks, size_t count)
{
    json_t *object = json_object();
    bool good = write_keys(object, tracks, count);
    for (size_t i = 0; i < count; i++)
        if (tracks[i].track->formula[0].text)
            good = put(object, tracks[i].formula, write_formulas(tracks[i].track)) && good;
    return finish(object, good);
}

static bool write_force(json_t *object, const char *name, const Track *track)
{
    Written written = {.name = "value", .formula = "formula", .track = track, .scale = 1.0};
    return !track_is_given(track) || put(object, name, write_tracks(&written, 1));
}

static bool write_camera(json_t *object, const Scene *scene)
{
    Written tracks[] = {{.name = "eye", .track = &scene->eye, .scale = 1.0},
                        {.name = "target", .track = &scene->target, .scale = 1.0},
                        {.name = "fov", .track = &scene->fov, .scale = 1.0}};
    bool given = false;
    for (size_t i = 0; i < 3; i++) {
        tracks[i].formula = tracks[i].name;
        if (!track_is_given(tracks[i].track)) continue;
        given = true;
        // A scene file has either the constant or the track.
        json_object_del(object, tracks[i].name);
    }
    return !given || put(object, "camera", write_tracks(tracks, 3));
}

static bool write_head(json_t *object, const RigidTrack *head)
{
    Written tracks[] = {
        {"translate", "translate", &head->translation, 1.0, 0},
        {"rotate", "rotate", &head->rotation, 1.0 / RIGID_TRACK_DEGREES.scale, 0},
    };
    if (!track_is_given(&head->translation) && !track_is_given(&head->rotation)) return true;
    json_t *track = write_tracks(tracks, 2);
    bool good = put(track, "pivot", scene_param_write_floats(head->pivot, 3));
    return put(object, "head", track) && good;
}

static json_t *write_light(const Light *light)
{
    bool far = light->kind == LIGHT_DIRECTIONAL;
    float way[3], color[3];
    for (int i = 0; i < 3; i++) {
        way[i] = (far ? -light->direction[i] : light->direction[i]) + 0.0f;
        color[i] = fminf((float)srgb_encode((double)light->color[i]), 1.0f);
    }
    json_t *object = json_object();
    bool good = put(object, "type", json_string(LIGHT_KIND_WORDS[light->kind]));
    if (!far) {
        good = put(object, "position", scene_param_write_floats(light->position, 3)) && good;
        good = put(object, "distance", scene_param_write_float(light->distance)) && good;
    }
    if (light->kind != LIGHT_POINT)
        good = put(object, "direction", scene_param_write_floats(way, 3)) && good;
    if (light->kind == LIGHT_SPOT) {
        good = put(object, "inner", scene_param_write_float(light->inner_deg)) && good;
        good = put(object, "outer", scene_param_write_float(light->outer_deg)) && good;
    }
    good = put(object, "color", scene_param_write_floats(color, 3)) && good;
    good = put(object, "intensity", scene_param_write_float(light->intensity)) && good;
    if (light->radius > 0)
        good = put(object, "radius", scene_param_write_float(light->radius)) && good;
    good = put(object, "shadow", json_boolean(light->shadow)) && good;
    return finish(object, good);
}

static bool write_lights(json_t *object, const Scene *scene)
{
    json_t *array = json_array();
    bool good = true;
    for (uint32_t i = 0; i < scene->light_count; i++)
        good = json_array_append_new(array, write_light(&scene->lights[i])) == 0 && good;
    return put(object, "lights", array) && good;
}

// Whether the parameter is a permission, which only the command line can give.
static bool is_permission(const ParamInfo *info)
{
    return strcmp(info->name, "allow_paths") == 0;
}

// Writes the parameters of a scope, those with tracks as tracks. `algo` is the section's solver.
static bool write_params(json_t *object, ParamScope scope, const void *params, const char *algo,
                         const SectionTracks *tracks)
{
    bool good = true;
    for (size_t i = 0; i < PARAM_COUNT; i++) {
        const ParamInfo *info = &PARAM_TABLE[i];
        if (info->scope == scope && params_owned_by(info, algo) && !is_permission(info))
            good = put(object, info->name,
                       section_tracks_has(tracks, info) ? section_keys_write(tracks, info)
                                                        : scene_param_write(info, params)) &&
                   good;
    }
    return good;
}

static bool write_sections(json_t *object, const Scene *scene, const SceneBody *body)
{
    json_t *array = json_array();
    bool good = true;
    for (uint32_t i = body->first; i < body->first + body->section_count; i++) {
        json_t *section = json_object();
        good = put(section, "file", scene_param_write_text(scene->sections[i].file)) && good;
        const SectionParams *params = &scene->sections[i].params;
        good = write_params(section, SCOPE_SECTION, params, params->algo,
                            &scene->sections[i].tracks) &&
               good;
        good = json_array_append_new(array, section) == 0 && good;
    }
    return put(object, "sections", array) && good;
}

static bool write_body(json_t *object, const Scene *scene, const SceneBody *body)
{
    bool good = write_params(object, SCOPE_BODY, &body->params, "", &(SectionTracks){0});
    good = write_head(object, &body->head) && good;
    if (body->colliders.count)
        good = put(object, "colliders", colliders_to_json(&body->colliders)) && good;
    return write_sections(object, scene, body) && good;
}

static bool write_list(json_t *object, const Scene *scene)
{
    json_t *array = json_array();
    bool good = true;
    for (uint32_t i = 0; i < scene->body_count; i++) {
        json_t *body = json_object();
        good = write_body(body, scene, &scene->bodies[i]) && good;
        good = json_array_append_new(array, body) == 0 && good;
    }
    return put(object, "bodies", array) && good;
}

json_t *scene_to_json(const Scene *scene)
{
    json_t *object = json_object();
    bool good = write_params(object, SCOPE_RUN, &scene->run, "", &(SectionTracks){0});
    good = write_force(object, "gravity", &scene->gravity) && good;
    good = write_force(object, "wind", &scene->wind) && good;
    good = write_camera(object, scene) && good;
    good = write_lights(object, scene) && good;
    good = (scene->body_count == 1 ? write_body(object, scene, &scene->bodies[0])
                                   : write_list(object, scene)) &&
           good;
    return finish(object, good);
}
